// SPDX-License-Identifier: Apache-2.0
// rule: A syntax error names file, line and column.
// spec: RI 3.2, Shading Language
// exit: 1
// message: error_syntax\.sl:@here:\d+: error: 
// timeout: 30
surface error_syntax()
{
    Ci = 1 + ; // @here
}
