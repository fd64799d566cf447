// SPDX-License-Identifier: Apache-2.0
// rule: A shader that ends in the middle is an error with a place.
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_truncated\.sl:\d+:\d+: error: 
// timeout: 30
surface hostile_truncated(float Kd = .5;)
{
    color c = mix(Cs, color(1, 0
