# Figures 2 and 4 of Dutta and Hoffmann: a block with a blind hole. Under the hole's bottom its skeleton
# is a plane, around that a parabolic torus (of the edge), beside the hole a cone.
algebraic3d

solid hole = cylinder (2, 2, 0; 2, 2, 1; 1)
         and plane (0, 0, 1; 0, 0, -1)
         and plane (0, 0, 3; 0, 0, 1);
solid plate = orthobrick (0, 0, 0; 4, 4, 2) and not hole;

tlo plate;
