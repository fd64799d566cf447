// SPDX-License-Identifier: Apache-2.0
// rule: A hundred thousand minus signs are a long expression or an error, not the end of the stack.
// spec: RI 3.2, Shading Language
// exit: 0 or 1
// append: '- ' * 100000 + '1; }'
// timeout: 30
// quiet: error: .*
surface hostile_unary() { Ci = 
