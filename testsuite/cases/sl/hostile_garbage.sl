// SPDX-License-Identifier: Apache-2.0
// rule: Bytes that are no shader are errors with a place. Their number is limited, and the message that says so speaks of
//   the file, not of a place in it.
// spec: RI 3.2, Shading Language; design (command line)
// exit: 1
// message: hostile_garbage\.sl:\d+(:\d+)?: error: 
// append: bytes((i * i * 7 + i * 13 + 5) % 255 + 1 for i in range(5000))
// quiet: error: too many errors
// timeout: 30

