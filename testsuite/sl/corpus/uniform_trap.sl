// SPDX-License-Identifier: Apache-2.0
// warns: variable 'count' is assigned a varying value
// warns: parameter 'result' is assigned a varying value
/* Assigns uniform variables in places where points take different ways. */
surface uniform_trap(uniform float seed = 1; output float result = 0;)
{
    uniform float count = 0, keep = seed;
    uniform float r = random();
    if (s > .5)
        count += 1;
    result = count * r;
    keep += 1;
    Ci = color (count, keep, result);
    Oi = 1;
}
