# Made the files beside it with LIGGGHTS-PUBLIC 3.8.0: liggghts -in in.make
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
region reg block -0.03 0.03 -0.03 0.03 0 0.1 units box
create_box 1 reg
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix g all gravity 9.81 vector 0 0 -1
fix zw all wall/gran model hertz tangential history primitive type 1 zplane 0.0
region bc cylinder z 0 0 0.02 0.003 0.05 units box
fix pts1 all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.003
fix pdd1 all particledistribution/discrete 32452843 1 pts1 1.0
fix ins all insert/pack seed 32452867 distributiontemplate pdd1 vel constant 0.1 0. -0.5 insert_every once overlapcheck yes all_in yes particles_in_region 12 region bc
fix integr all nve/sphere
thermo_style custom step atoms ke
thermo 1000
thermo_modify lost ignore norm no
run 1
dump a all custom 1000 many.dump radius z y x id type vx vy vz
dump b all custom 1000 post/f_*.dump id type x y z vx vy vz radius
dump c all custom/vtk 1000 post/v_*.vtk id type x y z vx vy vz radius
dump d all custom/vtk 1000 post/v_*.vtp id type x y z vx vy vz radius
dump e all custom/vtk 1000 post/v_*.vtu id type x y z vx vy vz radius
dump f all atom/vtk 1000 post/av_*.vtk
dump g all custom/vtk 1000 post/bin_*.vtk id type x y z vx vy vz radius
dump_modify g binary yes
dump h all custom/vtk 1000 post/bin_*.vtp id type x y z vx vy vz radius
dump_modify h binary yes
dump i all custom 1000 scaled.dump id xs ys zs radius
run 2000
