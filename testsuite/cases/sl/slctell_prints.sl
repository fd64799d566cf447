// SPDX-License-Identifier: Apache-2.0
// rule: slctell prints the shader's kind, name, parameters with class, type and default: a line for the parameter, one for
//   its default, as BMRT's did. The words between name and class are free.
// spec: BMRT manual; design (command line)
// run: slc -o slctell_prints.slo {case}
// needs: slctell
// run tell: slctell ../main/slctell_prints.slo
// output: ^displacement "slctell_prints"$
// output: ^ +"Km" ".*uniform float"$
// output: ^ +Default value: 0\.25$
// output: ^ +"file" ".*uniform string"$
// output: ^ +Default value: "mask"$
// output: ^ +"tint" ".*varying color"$
// output: ^ +Default value: "rgb" \[1 0\.5 0\]$
displacement slctell_prints(float Km = .25; uniform string file = "mask"; varying color tint = color(1, .5, 0);)
{
    P += Km * comp(tint, 0) * normalize(N);
}
