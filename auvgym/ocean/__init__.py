"""Real oceans: NetCDF currents and bathymetry become a scenario in local metres, and back.

    scenario = auvgym.ocean.load(
        currents="gulf_stream.nc", bathymetry="etopo.nc",
        start=(-70.5, 40.0), goal=(-69.0, 35.0), vehicle_speed_mps=1.0,
    )
    plan = auvgym.plan(auvgym.World(scenario), "astar")
    auvgym.ocean.to_lonlat(scenario, plan.waypoints)

Rooms, from the files to the scenario: ``files`` opens, ``names``, ``fields`` and ``refusals``
find the variables and their axes, ``sources`` holds both files, ``axes``, ``times`` and ``grids``
bring them to (time, depth, latitude, longitude) ascending, ``water`` and ``sea`` complete them;
``request`` is what was asked, ``mission``, ``projection`` and ``layout`` make the map, ``ends``
judges start and goal, ``loader`` writes it all down.
"""

from auvgym.ocean.files import OceanDataWarning
from auvgym.ocean.loader import build, load
from auvgym.ocean.projection import Projection, from_lonlat, to_lonlat
from auvgym.ocean.request import Request

__all__ = ["OceanDataWarning", "Projection", "Request", "build", "from_lonlat", "load", "to_lonlat"]
