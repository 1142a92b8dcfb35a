# A quarter of a transformer in its tank, cut along its planes of symmetry y = 0 and z = 0: two
# windings on a core with one window, in oil. Lengths in centimetres.
algebraic3d

solid cut = plane (0, 0, 0; 0, -1, 0)
        and plane (0, 0, 0; 0, 0, -1);
solid top = plane (0, 0, 7; 0, 0, 1);
solid primary = cut and top
         and cylinder (-13, 0, 0; -13, 0, 1; 11.5)
         and not cylinder (-13, 0, 0; -13, 0, 1; 8);
solid secondary = cut and top
         and cylinder (13, 0, 0; 13, 0, 1; 11.5)
         and not cylinder (13, 0, 0; 13, 0, 1; 8);
solid core = cut
         and orthobrick (-18, -5, -15; 18, 5, 15)
         and not orthobrick (-8, -6, -10; 8, 6, 10);
solid inside = orthobrick (-27, -14, -19; 27, 14, 19);
solid oil = cut and inside and not core and not primary and not secondary;
solid tank = cut and orthobrick (-29, -16, -21; 29, 16, 21) and not inside;

tlo primary;
tlo secondary;
tlo core;
tlo oil;
tlo tank;
