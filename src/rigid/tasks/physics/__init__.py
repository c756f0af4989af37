"""What every task on MuJoCo's native batch shares: scenes, stepping with faults, replays."""
