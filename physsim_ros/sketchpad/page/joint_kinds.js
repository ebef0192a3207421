// SPDX-License-Identifier: Apache-2.0
/** Kinds of joints at one point of both bodies, along the line between two points, and along an axis, as model/joints.py declares them. */

// kinds: made by `make tables`
export const AT_POINT = ['pin', 'axle', 'motor'];
export const ALONG_LINE = ['spring', 'rod', 'rope'];
export const ALONG_AXIS = ['slider'];
// end: made by `make tables`
