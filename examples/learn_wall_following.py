# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A robot learns to follow the wall on its right, by PPO of Stable-Baselines3.

pip install '/path/to/physsim_ros[gym]' stable-baselines3
python learn_wall_following.py --steps 150000

Without ROS. docs/tutorials/learn_to_follow_a_wall.md goes through it, and says what it learned.
"""

import argparse
import math

import numpy as np
from physsim_ros import find_world, load_world, robot_spawn, Simulation
from physsim_ros.gym import RobotEnv, Task

ROBOT = {
    'from': 'turtlebot3_burger',
    'sensors': [
        {'kind': 'laser', 'name': 'scan', 'beams': 36, 'range': [0.05, 3.5], 'noise': 0.01}
    ],
}
# Distance that the robot keeps from the wall on its right [m]; the corridor is 1 m wide.
DISTANCE = 0.35


def to_the_right(robot):
    """Return the distance of the nearest wall on the right, from the robot's middle [m]."""
    scan = np.clip(robot.scan(), 0.0, 3.5)
    # Beam k of 36 looks 10 degrees times k to the left of ahead: these look 220 to 320 degrees.
    return float(scan[22:33].min())


def reward(robot, _):
    """Return 1 for full speed ahead at the right distance, and -10 for a crash."""
    if robot.bumped:
        return -10.0
    speed = robot.truth().twist[0] / robot.description.drive.max_speed
    return speed * (1.0 - 2.0 * abs(to_the_right(robot) - DISTANCE))


def crashed(robot):
    """Return whether the robot has touched a wall."""
    return robot.bumped


def anywhere(robot, rng):
    """Put the robot somewhere in the corridor, facing either way."""
    along, aside, skew = rng.uniform(0.0, 9.0), rng.uniform(-0.2, 0.2), rng.uniform(-0.5, 0.5)
    back = math.pi * rng.integers(2)
    if along < 4.8:
        robot.place(along, aside, back + skew)
    else:
        robot.place(5.0 + aside, along - 4.8, math.pi / 2 + back + skew)


def make_task():
    """Return the task: a burger in the shipped corridor, for a minute."""
    simulation = Simulation()
    simulation.load(load_world(find_world('corridor')))
    simulation.perform(robot_spawn(ROBOT))
    return Task(
        world=simulation.save(), begin=anywhere, reward=reward, is_over=crashed, longest=60.0
    )


def evaluate(act, episodes=20):
    """Return crashes, mean path of an episode [m], and mean error of the distance [m]."""
    env = RobotEnv(make_task())
    crashes, paths, errors = 0, [], []
    for seed in range(episodes):
        observation, _ = env.reset(seed=10_000 + seed)
        over = cut = False
        path = 0.0
        while not (over or cut):
            observation, _, over, cut, _ = env.step(act(observation))
            path += env.robot.truth().twist[0] * env.task.period
            errors.append(abs(to_the_right(env.robot) - DISTANCE))
        crashes += over
        paths.append(path)
    return crashes, float(np.mean(paths)), float(np.mean(errors))


def main():
    """Learn, and print how it was before and after."""
    from stable_baselines3 import PPO  # noqa: PLC0415 - the rest is of use without it
    from stable_baselines3.common.vec_env import DummyVecEnv  # noqa: PLC0415

    parser = argparse.ArgumentParser(description='Learn to follow a wall.')
    parser.add_argument('--steps', type=int, default=150_000, help='training steps of 0.1 s')
    parser.add_argument('--worlds', type=int, default=8, help='number of worlds')
    parser.add_argument('--save', default='', help='file for what was learned')
    options = parser.parse_args()
    task = make_task()
    worlds = DummyVecEnv([lambda: RobotEnv(task)] * options.worlds)
    model = PPO('MlpPolicy', worlds, n_steps=256, batch_size=256, gamma=0.98, seed=0)

    def act(observation):
        return model.predict(observation, deterministic=True)[0]

    print('20 episodes of up to 60 s  crashes  path [m]  error of the distance [m]')
    print('before                    {:8d} {:8.2f} {:8.3f}'.format(*evaluate(act)))
    model.learn(options.steps)
    print('after {:7d} steps       {:8d} {:8.2f} {:8.3f}'.format(options.steps, *evaluate(act)))
    if options.save:
        model.save(options.save)


if __name__ == '__main__':
    main()
