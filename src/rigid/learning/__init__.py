"""How policies learn: rollouts, PPO, cloning, co-optimisation, personalisation, adversaries."""
