#GANTRY OFF [AX=X]
; Request free slave axes
#CALL AX [Axis_X1, 5, 4] ; log. axis no.4 at Index 3
#CALL AX [Axis_X2, 6, 5] ; log. axis no.4 at Index 4
; Move axes as independent CNC axes
G0 X=47;X previous master axis of gantry combination 1
G0 Axis_X1=11 ; Axis_X1 previous slave axis 1 of X
G0 Axis_X2=12 ; Axis_X2 previous slave axis 2 of X
M30
