// SPDX-License-Identifier: Apache-2.0
// rule: match(pattern, subject) is 1 where the basic regular expression matches anywhere; patterns that are none match
//   nothing, after a message; patterns made to take forever do not.
// spec: RI 3.2, Shading Language, String functions
// scene: plate 8
// message: warning: shader "match_rules": match\(\): "\[" is no basic regular expression
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface match_rules(string broken = "["; string slow = "\\(a*\\)*\\(a*\\)*\\(a*\\)*b$";)
{
    BEGIN_CHECKS
    string longest = "a";
    float i;
    for (i = 0; i < 11; i += 1)
        longest = concat(longest, longest);
    CHECK("anywhere", match("oo", "wood"), 1, 0)
    CHECK("at the beginning", match("^oo", "wood"), 0, 0)
    CHECK("at the end", match("wo*d$", "firewood"), 1, 0)
    CHECK("any character", match("w..d", "wood"), 1, 0)
    CHECK("set", match("[0-9][^0-9]", "floor7b"), 1, 0)
    CHECK("class", match("[[:upper:]]", "wood"), 0, 0)
    CHECK("group", match("^\\(ab\\)*c", "ababc"), 1, 0)
    CHECK("counted", match("^a\\{3\\}$", "aaa"), 1, 0)
    CHECK("basic: + is itself", match("a+b", "aab"), 0, 0)
    CHECK("no expression", match(broken, "["), 0, 0)
    CHECK("soon", match(slow, longest), 0, 0)
    END_CHECKS
}
