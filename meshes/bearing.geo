# A bearing block: a foot with two bolt holes, a round boss with a blind hole.
algebraic3d

solid foot = orthobrick (-30, -15, 0; 30, 15, 10);
solid boss = cylinder (0, 0, 0; 0, 0, 1; 11)
         and plane (0, 0, 5; 0, 0, -1)
         and plane (0, 0, 24; 0, 0, 1);
solid seat = cylinder (0, 0, 0; 0, 0, 1; 6)
         and plane (0, 0, 14; 0, 0, -1)
         and plane (0, 0, 30; 0, 0, 1);
solid bolts = cylinder (-21, 0, 0; -21, 0, 1; 4)
           or cylinder (21, 0, 0; 21, 0, 1; 4);

solid bearing = (foot or boss) and not seat and not bolts;

tlo bearing -maxh=3;
