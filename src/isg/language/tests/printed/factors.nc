
:
N10 #SET AX LINK[1, [Y2 = Y1,1,-1]] Mirror coupling (factor -1)
N20 #SET AX LINK[1, [Y2 = Y1,-1,1]] Mirror coupling (factor -1)
N30 #SET AX LINK[1, [Y2 = Y1,-2,2]] Mirror coupling (factor -1)
N40 #SET AX LINK[1, [Y2 = Y1,1,1]] Default coupling
N50 #SET AX LINK[1, [Y2 = Y1,2,2]] Default coupling
N60 #SET AX LINK[1, [Y2 = Y1,0,1]] Error message, program is aborted
N70 #SET AX LINK[1, [Y2 = Y1,1,0]] Error message, program is aborted
N80 #SET AX LINK[1, [Y2 = Y1,1,2]] Warning (factor 0.5), default cpl.
N90 #SET AX LINK[1, [Y2 = Y1,2,3]] Warning (factor 0.666), default cpl.
N100 #SET AX LINK[1, [Y2 = Y1,3,2]] Warning (factor 1.5), default cpl.
N110 #SET AX LINK[1, [Y2 = Y1,-1,2]] Warning (factor -0.5), default cpl.
N120 #SET AX LINK[1, [Y2 = Y1,-3,2]] Warning (factor -1.5), default cpl.

