"""A scenario file that says everything that one can."""

# One of everything that a file can say.
EVERYTHING = """
schema = 1
name = "everything"
description = "One of every kind."
dimensions = 3
notes = ["made by hand"]

[domain]
min_m = [0.0, 0.0, 0.0]
max_m = [20000, 20000, 4000]
margin_m = 400.0

[limits]
goal_radius_m = 250.0
time_factor = 2.0
energy_factor = 3.0

[vehicle]
speed_mps = 1.5

[episode]
tick_s = 10.0

[sections]
count = 20
spacing_m = 1000.0
cell_m = 500.0

[seabed]
kind = "peaks"
floor_depth_m = 4000.0
peaks = [{ x_m = 5000, y_m = 8000, height_m = 2500, a = 0.8, b = 1.1, sigma_m = 1800 }]

[change]
kind = "table"
every_m = 6000.0
hold_margin_m = 900.0
phases = [
  { obstacles_m = [[7000, 9000, 1000], [3000, 5000, 0], [15000, 5000, 500],
                   [16000, 15000, 1500], [4000, 16000, 500]], vortices_m = [[9000, 9000]] },
]

[[missions]]
start_m = [10000.0, 0.0, 1000.0]
goal_m = [10000.0, 19000.0, 1000.0]

[[currents]]
kind = "uniform"
velocity_mps = [0.1, -0.2]

[[currents]]
kind = "vortices"
core_radius_m = 1200.0
vortices = [{ x_m = 9000, y_m = 12000, circulation_m2ps = 2000, drift_mps = [0.1, 0.2] }]

[[currents]]
kind = "jet"
t = 3.0
c = 1.2
k = 0.8
e = 0.1
b0 = 2.2
omega = 0.4
chi = 1.5707963267948966
peak_speed_mps = 0.5
length_scale_m = 2000.0
time_scale_s = 3600.0
origin_m = [0.0, 10000.0]

[[currents]]
kind = "gridded"
x_m = [0, 10000, 20000]
y_m = [0, 20000]
depth_m = [0, 1000]
time_s = [0, 3600]
u_mps = "f32le:zczMPc3MTD6amZk+AADAf83MTD3NzMw9zczMPZqZGT7NzEw+AACAPgAAAD8AAIA+zczMPc3MTD6amZk+AADAf83MTD3NzMw9zczMPZqZGT7NzEw+AACAPgAAAD8AAIA+"
v_mps = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1]

[[obstacles]]
kind = "sphere"
position_m = [6000, 12000, 1500]
radius_m = 800.0
velocity_mps = [0.3, -0.1, 0.05]

[[obstacles]]
kind = "disc"
position_m = [3000, 4000]
radius_m = 700.0

[[obstacles]]
kind = "cylinder"
position_m = [15000, 4000]
radius_m = 600.0
top_m = 500.0
bottom_m = 2500.0

[[obstacles]]
kind = "superquadric"
position_m = [16000, 14000, 2000]
semi_axes_m = [900.0, 700.0, 500.0]
exponents = [2.0, 4.0, 2.0]

[[obstacles]]
kind = "polygon"
vertices_m = [[2000, 15000], [6000, 15000], [6000, 17000], [4000, 16000], [2000, 17000]]
top_m = -10.0
bottom_m = 1000.0
"""  # noqa: E501
