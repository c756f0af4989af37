"""A study played through by scripts over real HTTP and WebSockets, before people come."""
