"""What the ocean community calls things: names, CF standard names and units."""

from __future__ import annotations

CURRENT_PAIRS = (
    ("utotal", "vtotal"),
    ("uo", "vo"),
    ("water_u", "water_v"),
    ("u", "v"),
    ("vozocrtx", "vomecrty"),
    ("ucur", "vcur"),
    ("u_current", "v_current"),
    ("current_u", "current_v"),
    ("ssu", "ssv"),
    ("ugos", "vgos"),
)
EASTWARD = ("eastward_sea_water_velocity", "sea_water_x_velocity")
NORTHWARD = ("northward_sea_water_velocity", "sea_water_y_velocity")
# A variable called u may also be the wind's.
NOT_A_CURRENT = ("wind", "stokes", "wave", "sea_ice", "air")

DEPTH_STANDARD_NAMES = (
    "sea_floor_depth",
    "sea_floor_depth_below_geoid",
    "sea_floor_depth_below_geopotential_datum",
    "sea_floor_depth_below_mean_sea_level",
    "sea_floor_depth_below_reference_ellipsoid",
    "sea_floor_depth_below_sea_surface",
    "model_sea_floor_depth_below_geoid",
    "depth",
)
HEIGHT_STANDARD_NAMES = (
    "height",
    "altitude",
    "surface_altitude",
    "bedrock_altitude",
    "height_above_geoid",
    "height_above_mean_sea_level",
    "height_above_reference_ellipsoid",
    "height_above_geopotential_datum",
)
# Names in the order of preference, and whether their numbers grow downwards.
BATHYMETRY_NAMES = {
    "deptho": "down",
    "bathymetry": "down",
    "bathy": "down",
    "bathymetrie": "down",
    "seafloor_depth": "down",
    "sea_floor_depth": "down",
    "model_depth": "down",
    "elevation": "up",
    "topo": "up",
    "topography": "up",
    "rose": "up",
    "relief": "up",
    "altitude": "up",
    "bed": "up",
    "etopo": "up",
    "band1": "up",
    "h": "down",
    "z": "up",
}

AXIS_NAMES = {
    "longitude": ("longitude", "lon", "long", "nav_lon", "xlon"),
    "latitude": ("latitude", "lat", "nav_lat", "ylat"),
    "depth": ("depth", "deptht", "depthu", "depthv", "lev", "level", "z", "zt", "z_t"),
    "time": ("time", "ocean_time", "time_counter", "t"),
}
AXIS_STANDARD_NAMES = {
    "longitude": "longitude",
    "latitude": "latitude",
    "depth": "depth",
    "height": "depth",
    "altitude": "depth",
    "time": "time",
}
_EAST = {"degrees_east", "degree_east", "degreee", "degreese", "degree_e", "degrees_e"}
_NORTH = {"degrees_north", "degree_north", "degreen", "degreesn", "degree_n", "degrees_n"}

_METRES = {"m", "meter", "meters", "metre", "metres"}
_SPEEDS = {
    "m/s": 1.0,
    "cm/s": 0.01,
    "mm/s": 0.001,
    "kn": 1852.0 / 3600.0,
    "kt": 1852.0 / 3600.0,
    "knot": 1852.0 / 3600.0,
    "knots": 1852.0 / 3600.0,
}


def text(attributes: dict[str, object], key: str) -> str:
    """An attribute as lower-case text, "" where it is absent."""
    return str(attributes.get(key, "")).strip().lower()


def axis_kind(name: str, attributes: dict[str, object]) -> str | None:
    """Which axis a coordinate is by its attributes, else by its name; None for no known one."""
    units = text(attributes, "units")
    standard = text(attributes, "standard_name")
    if units in _EAST:
        return "longitude" if not standard.startswith("grid_") else None
    if units in _NORTH:
        return "latitude" if not standard.startswith("grid_") else None
    if " since " in units:
        return "time"
    if standard:
        if standard in AXIS_STANDARD_NAMES:
            return AXIS_STANDARD_NAMES[standard]
        if is_terrain_following(name, attributes):
            return None
    axis = text(attributes, "axis")
    if axis == "z" or (text(attributes, "positive") in ("up", "down") and is_metres(units)):
        return "depth"
    if axis == "t":
        return "time"
    lower = name.lower()
    return next((kind for kind, names in AXIS_NAMES.items() if lower in names), None)


def is_terrain_following(name: str, attributes: dict[str, object]) -> bool:
    """Whether a vertical coordinate follows the sea floor (sigma levels) instead of depths."""
    standard = text(attributes, "standard_name")
    return standard.startswith(("ocean_sigma", "ocean_s_coordinate", "ocean_double_sigma")) or (
        name.lower() in ("siglay", "siglev", "sigma", "s_rho", "s_w", "sc_r")
    )


def is_metres(units: str) -> bool:
    """Whether a unit of length is the metre."""
    return units.strip().lower() in _METRES


def speed_factor(units: str) -> float | None:
    """What a speed in ``units`` is multiplied with to be m/s; None for a unit that is not known."""
    unit = units.strip().lower().replace("metres", "m").replace("meters", "m")
    unit = unit.replace("metre", "m").replace("meter", "m").replace("seconds", "s")
    unit = unit.replace("second", "s").replace("sec", "s").replace("**", "").replace("^", "")
    unit = unit.replace(".", " ").replace(" s-1", "/s").replace("s-1", "/s").replace(" ", "")
    return _SPEEDS.get(unit)
