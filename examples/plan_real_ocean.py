"""Plan the fastest way through a real current, fly it, and compare it with steering at the goal.

python examples/plan_real_ocean.py currents.nc --bathymetry floor.nc \
    --start -70.5 40 --goal -69 35 --speed 1 --out plan.csv

Needs: pip install "auvgym[ocean]"
"""

import argparse
import warnings

import gymnasium
import numpy as np

import auvgym


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("currents", help="NetCDF file of currents")
    parser.add_argument("--bathymetry", help="NetCDF file of the sea floor")
    place = {"nargs": 2, "type": float, "metavar": ("LON", "LAT"), "required": True}
    parser.add_argument("--start", **place)
    parser.add_argument("--goal", **place)
    parser.add_argument("--speed", type=float, default=1.0, help="through water, m/s")
    parser.add_argument("--planner", default="astar", choices=auvgym.list_planners())
    parser.add_argument("--out", help="write longitude, latitude, depth to this CSV file")
    arguments = parser.parse_args()

    # What the loader warns of is in the notes, too.
    warnings.simplefilter("ignore", auvgym.ocean.OceanDataWarning)
    scenario = auvgym.ocean.load(
        currents=arguments.currents,
        bathymetry=arguments.bathymetry,
        start=arguments.start,
        goal=arguments.goal,
        vehicle_speed_mps=arguments.speed,
    )
    for note in scenario.notes:
        print("note:", note)

    world = auvgym.World(scenario)
    plan = auvgym.plan(world, arguments.planner, cost="time")
    time_s = auvgym.path_cost(world, plan.waypoints, cost="time")["time_s"]
    planned = f"{time_s / 3600:.1f} h" if plan.feasible else "no way found"
    still_h = np.linalg.norm(world.goal - world.start) / arguments.speed / 3600
    print(f"straight in still water: {still_h:.1f} h")
    print(f"{plan.planner}, planned: {planned}")
    print(f"{plan.planner}, flown:   {fly(scenario, plan.planner, cost='time')}")
    print(f"straight, flown: {fly(scenario, 'straight')}")

    if arguments.out:
        places = auvgym.ocean.to_lonlat(scenario, plan.waypoints)
        header = "longitude_deg,latitude_deg,depth_m"
        np.savetxt(arguments.out, places, "%.6f", ",", header=header, comments="")
        print(f"{len(places)} waypoints: {arguments.out}")


def fly(scenario, policy_name: str, **parameters) -> str:
    env = gymnasium.make("AUVDynamic2D-v0", scenario=scenario)
    policy = auvgym.policies.make(policy_name, **parameters)
    observation, info = env.reset(seed=0)
    policy.reset(env)
    while info["outcome"] == "running":
        observation, _, _, _, info = env.step(policy.act(observation, info))
    return f"{info['outcome']} after {info['time_s'] / 3600:.1f} h"


if __name__ == "__main__":
    main()
