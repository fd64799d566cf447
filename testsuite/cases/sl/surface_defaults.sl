// SPDX-License-Identifier: Apache-2.0
// rule: A shader that assigns nothing shows Cs with opacity Os.
// spec: RI 3.2, Shading Language, Surface shaders
// scene: plate 8
// expect: mean("out.tif") == vec(1, 1, 1, 1)
surface surface_defaults()
{
}
