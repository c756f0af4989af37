"""Does a measurement say the same when it is made again, with nothing but the robot kept?"""
