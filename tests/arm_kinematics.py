"""Place and Jacobian of the arms of apps/config by Orocos KDL and by MuJoCo: tests/reference/arms.csv, which
tests/unit/test_linkage.c reads. KDL is asked with its own functions for Denavit and Hartenberg's rows, MuJoCo with bodies
whose places are worked out here; both must agree with the file to 1e-13.

    python arm_kinematics.py [renew]
"""
import configparser, math, pathlib, random, sys

import mujoco
import numpy as np
import PyKDL as kdl

ARMS = ["ur5e", "fr3", "iiwa7", "planar"]
POSTURES = 5
BASE = [0.1, -0.2, 0.3, 0.4, -0.5, 0.6]  # x y z, roll pitch yaw: as test_linkage.c writes it behind each table
FILE = pathlib.Path("tests/reference/arms.csv")


def read(name):
    ini = configparser.ConfigParser(inline_comment_prefixes=";")
    ini.read(f"apps/config/{name}.arm")
    get = lambda section, key: float(ini.get(section, key, fallback=0))
    joints = [s for s in ini.sections() if s.startswith("joint")]
    rows = [[get(j, k) for k in ("a", "alpha", "d", "offset")] for j in joints]
    travel = [(get(j, "least"), get(j, "most")) for j in joints]
    return ini["arm"]["convention"] == "modified", rows, travel, [get("tool", k) for k in ("x", "y", "z", "facing_z")]


def by_kdl(modified, rows, tool, q):
    fixed = lambda frame: kdl.Segment(kdl.Joint(), frame)
    frames = [(kdl.Frame.DH_Craig1989 if modified else kdl.Frame.DH)(*row) for row in rows]
    chain = kdl.Chain()
    chain.addSegment(fixed(kdl.Frame(kdl.Rotation.RPY(*BASE[3:]), kdl.Vector(*BASE[:3]))))
    if modified:  # a row stands before its joint
        chain.addSegment(fixed(frames[0]))
        frames = frames[1:] + [kdl.Frame()]
    for frame in frames:
        chain.addSegment(kdl.Segment(kdl.Joint(kdl.Joint.RotZ), frame))
    chain.addSegment(fixed(kdl.Frame(kdl.Vector(*tool[:3]))))
    angles = kdl.JntArray(len(q))
    for i, angle in enumerate(q):
        angles[i] = angle
    frame, jacobian = kdl.Frame(), kdl.Jacobian(len(q))
    kdl.ChainFkSolverPos_recursive(chain).JntToCart(angles, frame)
    kdl.ChainJntToJacSolver(chain).JntToJac(angles, jacobian)
    columns = [jacobian[k, i] for i in range(len(q)) for k in range(6)]
    return np.array([*frame.p, *(frame.M.UnitZ() * (tool[3] or 1)), *columns])


def by_mujoco(modified, rows, tool, q):
    numbers = lambda values: " ".join(f"{v:.17g}" for v in values)
    about_x = lambda alpha: numbers([math.cos(alpha / 2), math.sin(alpha / 2), 0, 0])
    turn = np.zeros(4)
    mujoco.mju_euler2Quat(turn, np.array(BASE[:2:-1]), "zyx")
    mass = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
    text, at, quat = f'<body pos="{numbers(BASE[:3])}" quat="{numbers(turn)}">', [0, 0, 0], "1 0 0 0"
    for a, alpha, d, offset in rows:
        assert offset == 0
        if modified:  # a row stands before its joint
            at, quat = [a, -d * math.sin(alpha), d * math.cos(alpha)], about_x(alpha)
        text += f'<body pos="{numbers(at)}" quat="{quat}">{mass}<joint axis="0 0 1"/>'
        at, quat = ([0, 0, 0], "1 0 0 0") if modified else ([a, 0, d], about_x(alpha))
    text += f'<body pos="{numbers(at)}" quat="{quat}"><site pos="{numbers(tool[:3])}"/></body>' + "</body>" * (len(rows) + 1)
    model = mujoco.MjModel.from_xml_string(f'<mujoco><compiler angle="radian"/><worldbody>{text}</worldbody></mujoco>')
    data = mujoco.MjData(model)
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    moves, turns = np.zeros((3, len(q))), np.zeros((3, len(q)))
    mujoco.mj_jacSite(model, data, moves, turns, 0)
    return np.array([*data.site_xpos[0], *data.site_xmat[0][[2, 5, 8]] * (tool[3] or 1), *np.vstack([moves, turns]).T.ravel()])


def postures():
    draw = random.Random(1)
    for name in ARMS:
        modified, rows, travel, tool = read(name)
        for _ in range(POSTURES):
            q = [draw.uniform(*ends) for ends in travel]
            yield name, q, by_kdl(modified, rows, tool, q), by_mujoco(modified, rows, tool, q)


def main():
    if sys.argv[1:] == ["renew"]:
        lines = ["# arm, count, angles, place x y z, facing x y z, for each joint j x y z and axis x y z: by tests/arm_kinematics.py\n"]
        lines += [",".join([name, str(len(q))] + [f"{v:.17g}" for v in [*q, *by]]) + "\n" for name, q, by, _ in postures()]
        FILE.write_text("".join(lines))
    worst = {"KDL": 0.0, "MuJoCo": 0.0}
    lines = [line for line in FILE.read_text().splitlines() if not line.startswith("#")]
    for line, (name, q, *peers) in zip(lines, postures(), strict=True):
        stored = np.array([float(v) for v in line.split(",")[2 + len(q):]])
        for peer, values in zip(worst, peers):
            worst[peer] = max(worst[peer], np.abs(values - stored).max())
    print(f"{len(lines)} postures of {len(ARMS)} arms: " + ", ".join(f"{peer} within {off:.1e}" for peer, off in worst.items()))
    sys.exit(not max(worst.values()) <= 1e-13)


main()
