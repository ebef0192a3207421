# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
A world and its time: requests go in, frames come out, any past step can be gone back to.

No physics (that is `engine`), no files, topics or threads. Start with `simulation`, the front,
then `request_handler` and `playback` (the moment that is shown); the folder `past` has what is
kept for going back, `world` the present and what requests do to it.
"""
