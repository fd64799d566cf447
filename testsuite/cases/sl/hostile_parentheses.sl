// SPDX-License-Identifier: Apache-2.0
// rule: A hundred thousand parentheses end in one error with a place, not with the stack.
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_parentheses\.sl:\d+:\d+: error: 
// append: '(' * 100000
// timeout: 30
surface hostile_parentheses() { Ci = 
