"""The rock that small studies of the tests are of: all that a material may state but a hardness."""

ROCK = {
    "modulus": "20 GPa",
    "poisson": 0.2,
    "basic_friction_angle": "30 deg",
    "joint_wall_strength": "80 MPa",
}
