#GANTRY OFF [AX=X]
; Request free slave axes
#CALL AX [Axis_X1, 5, 4]
#CALL AX [Axis_X2, 6, 5]
; Move axes as independent CNC axes
G0 X=47;X previous master axis of gantry combination 1
G0 Axis_X1=11 ; Axis_X1 previous slave axis 1 of X
G0 Axis_X2=12 ; Axis_X2 previous slave axis 2 of X
;...
#GANTRY ON [AX=X] ; Restore gantry combination 1
G0 X=65 ; Assigned slave axes 1 and 2 also move with
M30
