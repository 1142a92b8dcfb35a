# A pipe flange: a disc with a hub, a bore and six bolt holes.
algebraic3d

solid bore = cylinder (0, 0, 0; 0, 0, 1; 12);

solid disc = cylinder (0, 0, 0; 0, 0, 1; 50)
         and plane (0, 0, 0; 0, 0, -1)
         and plane (0, 0, 10; 0, 0, 1);

solid hub = cylinder (0, 0, 0; 0, 0, 1; 22)
        and plane (0, 0, 0; 0, 0, -1)
        and plane (0, 0, 30; 0, 0, 1);

solid bolts = cylinder (37, 0, 0; 37, 0, 1; 5)
           or cylinder (18.5, 32.0429399, 0; 18.5, 32.0429399, 1; 5)
           or cylinder (-18.5, 32.0429399, 0; -18.5, 32.0429399, 1; 5)
           or cylinder (-37, 0, 0; -37, 0, 1; 5)
           or cylinder (-18.5, -32.0429399, 0; -18.5, -32.0429399, 1; 5)
           or cylinder (18.5, -32.0429399, 0; 18.5, -32.0429399, 1; 5);

solid flange = (disc or hub) and not bore and not bolts;

tlo flange -maxh=4;
