(Initialisation program)
%L UP_INIT_ACHS_KOPPL
(initialise axis coupling 1)
N10 #SET AX LINK[1, Y_S=Y, Z_S=Z, C_S=C]
(or #AX LINK[1, Y_S=Y, Z_S=Z, C_S=C]
N20 M17

(tool changing program)
%L UP_WZ
N30 #DISABLE AX LINK (oder #AX LINK OFF)
(Approach tool change position)
N40 G01 G90 Y1000 Z100 C0 Y_S=1000 Z_S=100 C_S=0
(tool change; T10 contains all tool axis offsets and the tool lengths of
master and slave tools; or these values are explicitly included in the
calculation.) )
N50 T10 D10
:
(Further commands for physical tool change)
:
(Approach old coupling position. The coupling position may also be
defined by parameter programming and then be used by the subroutine.)
N80 G01 G90 X20 Y20 Z40 C50 Y_S=20 Z_S=40 C_S=50
N90 #ENABLE AX LINK[1] (or #AX LINK ON[1])
N110 M17

(Subroutine for contour machining)
%L UP1
N150 G01 G91 X10 Y10 Z-20 C90
N160 G02 X20 Y20 I10 J10
N170 LL UP_WZ
N180 G01 G91 X10 Y10 Z-20 C90
N190 G02 X20 Y20 I10 J10
N200 M17

(Main program; initial condition: Both tools were changed.)
(Move both axis systems to coupling position first.)
N300 G01 G91 X20 Y20 Z40 C50 Y_S=20 Z_S=40 C_S=50 F300
(Start synchronous operation)
N310 #ENABLE AX LINK[1] (or #AX LINK ON[1])
N320 LL UP1
:
N400 #DISABLE AX LINK (or #AX LINK OFF)
N410 M30
