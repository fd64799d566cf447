// SPDX-License-Identifier: Apache-2.0
// rule: Bytes that are no shader are errors with a place.
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_garbage\.sl:\d+(:\d+)?: (warning|error): 
// append: bytes((i * i * 7 + i * 13 + 5) % 255 + 1 for i in range(5000))
// quiet: error: too many errors
// timeout: 30

