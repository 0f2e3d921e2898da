
N40 #AX LINK[1, [Y2 = Y1,1,1]] Default coupling
N50 #AX LINK NBR[1, [8 = 2,2,2]] Standard coupling via log. axis numbers

