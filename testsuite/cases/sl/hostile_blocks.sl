// SPDX-License-Identifier: Apache-2.0
// rule: A hundred thousand open blocks end in an error with a place.
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_blocks\.sl:\d+:\d+: error: 
// append: '{' * 100000
// timeout: 30
surface hostile_blocks() 
