# Figure 1 of Dutta and Hoffmann: a block, whose skeleton has 13 planar sheets.
algebraic3d

solid block = orthobrick (0, 0, 0; 4, 3, 2);

tlo block;
