C     A damper about z: USER(c, I, J) is the torque -c WZ(I, J).
      SUBROUTINE SFOSUB(ID, TIME, PAR, NPAR, DFLAG, IFLAG, VALUE)
      INTEGER ID, NPAR
      DOUBLE PRECISION TIME, PAR(*), VALUE
      LOGICAL DFLAG, IFLAG
C
      INTEGER IDS(2)
      DOUBLE PRECISION RATE
      LOGICAL FAILED
C
      IDS(1) = INT(PAR(2))
      IDS(2) = INT(PAR(3))
      CALL SYSFNC('WZ', IDS, 2, RATE, FAILED)
      CALL ERRMES(FAILED, 'the damper has no rate', ID, 'STOP')
      VALUE = -PAR(1)*RATE
      END
