"""The tasks as environments of other libraries: one world each, two players or one."""
