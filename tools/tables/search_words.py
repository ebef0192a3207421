# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Words that people search for, and the page or the section of it that answers.

Each becomes an entry of the index, which the search ranks above the words of the text. A section
is named by its heading as it is written.
"""

WORDS: dict[tuple[str, str], str] = {
    ('actors', ''): (
        'actor, pedestrian, people, crowd, ORCA, social force, door, lift, moving '
        'obstacle'
    ),
    ('beside_others', ''): (
        'Gazebo, flatland, Stage, ir-sim, MVSim, Algodoo, PhET, turtlesim, Pymunk, Box2D, '
        'alternatives'
    ),
    ('cheat_sheet', ''): 'keyboard, keys, shortcuts, shortcut, hotkeys, gestures, strokes, print',
    ('classroom', ''): 'class, pupils, students, teacher, school, freeze, lock, QR code',
    ('classroom', 'In the language of the class'): 'language, German, translation',
    ('convert', ''): 'convert, import, Tiled, RUBE, SDF, URDF, XML, migrate',
    ('drawing', ''): 'draw, pen, stroke, sketch, tablet, stylus, knife, tool, click',
    ('figures', ''): 'performance, benchmark, CPU, cost, how many bodies',
    ('glossary', ''): 'terms, words',
    ('howto', '… push a body, or drive it'): 'push, wrench',
    ('howto', '… run two worlds at once'): 'two worlds, second world',
    ('howto', '… save a world and load it again'): 'save, load',
    ('installation', ''): (
        'install, pip, colcon, rosdep, wheel, requirements, uninstall, disk space'
    ),
    ('installation', 'In a workspace'): 'launch, launch file, workspace',
    ('installation', 'In a container'): 'Docker, podman, container, devcontainer',
    ('installation', 'Many people on one network'): 'ROS_DOMAIN_ID, domain, network',
    ('interface', 'Several worlds'): 'namespace, remap',
    ('interface/codes', ''): 'error, refusal, refused, code, event',
    ('interface/parameters', ''): (
        'parameter, settings, configuration, gravity, physics_rate, bounds'
    ),
    ('interface/properties', 'A body from a marker'): (
        'mass, density, friction, elasticity, restitution, bounce, bouncy, bounciness, '
        'force, thruster, collision group, sensor, conveyor, belt, one-way, platform, shape, '
        'rolling resistance, water, fluid, buoyancy, float, drag, wind, medium, charge, '
        'attraction, material, rubber'
    ),
    ('interface/properties', 'A joint from a marker'): (
        'joint, spring, motor, hinge, axle, rod, rope, gear, slider, pin, weld, damper, pulley, '
        'constraint, winch, block and tackle, rack, pinion, ratchet, torsion spring'
    ),
    ('interface/properties', 'Sensors of a robot'): (
        'laser, lidar, scan, IMU, GPS, bumper, range finder, line sensor, encoder, noise'
    ),
    ('interface/simulation_interfaces', ''): (
        'simulation_interfaces, spawn_entity, standard services'
    ),
    ('interface/topics', ''): 'topic, service, QoS, spawn, marker, message',
    ('interface/topics', 'Output'): 'poses, states, contacts, diagnostics, clock',
    ('interface/world_files', ''): 'world file, YAML, file format',
    ('interface/world_files', 'Maps'): 'map_server, occupancy grid',
    ('learning', ''): 'Gymnasium, gym, reinforcement learning, RL, PPO, environment',
    ('learning', 'A sweep'): 'sweep, experiment, Dask, parallel, Monte Carlo',
    ('lessons', ''): (
        'lesson, exercise, free fall, question, curriculum, homework, quiz, worksheet, experiment'
    ),
    ('physics', ''): 'accuracy, tolerance, law, energy, momentum, solver',
    ('physics', 'Limits'): 'limits, limitations, mass ratio, stack',
    ('physics', 'The same bits'): 'deterministic, determinism, reproducible, bit',
    ('python', ''): 'Python, library, Simulation, without ROS, script',
    ('questions', ''): 'problem, trouble, troubleshooting, help, FAQ, does not move, stuck, slow',
    ('questions', 'How do I make stacks or joints stiffer?'): 'unstable, explosion, jitter, stiff',
    ('robots', ''): 'robot, differential drive, odometry, Ackermann, car-like, wheel, slip',
    ('robots', 'Battery and docks'): 'battery, dock, charge of a robot',
    ('robots', 'Drive, floor and odometry'): 'latency, delay, traction',
    ('robots', 'Trailers'): 'trailer, hitch, tow',
    ('robots', 'Arms and grippers'): 'arm, gripper, joint_command, trajectory, servo',
    ('robots', 'Topics'): (
        'cmd_vel, odom, twist, tf, robot_description, joint_states, teleop, joystick, gamepad'
    ),
    ('nav2', ''): 'Nav2, navigation, AMCL, SLAM, costmap',
    ('robots', 'A controller in another process'): 'lockstep, synchronous, control loop',
    ('robots', 'Maps'): 'map, walls',
    ('security', ''): 'security, token, password, firewall, attack',
    ('security', 'An enclave (SROS 2)'): 'SROS, encryption, enclave, permissions',
    ('testing', ''): 'pytest, fixture, test, unit test, physsim fixture',
    ('another_process', ''): 'C++, executable, integration test, launch test, subprocess',
    ('another_process', 'In CI'): 'CI, continuous integration, GitHub Actions',
    ('time', ''): (
        'time, pause, play, speed, slow motion, step, rewind, fast forward, backward, seek, reset'
    ),
    ('time', 'Undo'): 'undo, redo',
    ('time', 'Courses'): 'course, branch, ghost, past',
    ('time', 'Memory'): 'history, memory',
    ('viewers', ''): 'viewer, visualization, display, plot',
    ('viewers', 'Rerun'): 'Rerun, record, recording, rrd',
    ('viewers', 'Bags'): 'bag, rosbag, rosbag2, MCAP, replay',
    ('viewers', 'RViz and Foxglove'): 'RViz, Foxglove, interactive markers',
    ('worlds', ''): (
        'world, example, pendulum, dominoes, bridge, catapult, crane, Galton, harbour, maze, '
        'Newton, cradle, orbit, planets, demo, inclined plane, line follower'
    ),
    ('tutorials/record_and_look', 'Take the numbers out'): 'CSV, export, spreadsheet, log',
}  # fmt: skip


def with_entries(name: str, text: str) -> str:
    """
    Return the source of a page with its entries of the index.

    :raises ValueError: a heading is not there
    """
    for (page, heading), words in WORDS.items():
        if page != name:
            continue
        main = ', '.join(f'! {word.strip()}' for word in words.split(','))
        entry = f'```{{index}} {main}\n```\n\n'
        if not heading:
            text = entry + text
            continue
        line = f'\n## {heading}\n'
        if line not in text:
            raise ValueError(f'{name} has no heading {heading!r}')
        text = text.replace(line, f'\n{entry.rstrip()}\n{line}', 1)
    return text
