
:
N10 #SET AX LINK[1, [Y2 = Y1,G,0.01,0.25]]
# Gantry coupling of Y1 as master axis and Y2 as slave
# axis. 1st limit is 10µm, 2. Limit is 250 µm.

N20 #SET AX LINK[2, [Y2 = Y1,G]]
# Gantry coupling of Y1 (master) and Y2 (slave). The
# monitoring limits of the axis parameter data record of Y2 apply.

N30 #SET AX LINK [3,[Y2 = Y1]]
# Default coupling of Y2 with Y1. No gantry mode.
# or alternative
N10 #AX LINK[1, [Y2 = Y1,G,0.01,0.25]]

N20 #AX LINK NBR[2, [8 = 2,G]]
# Gantry coupling via logical axis numbers
  
