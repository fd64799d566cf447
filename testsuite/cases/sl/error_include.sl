// SPDX-License-Identifier: Apache-2.0
// rule: A missing include file is an error at the line that names it.
// spec: RI 3.2, Shading Language
// exit: 1
// message: error_include\.sl:@here:(\d+:)? ?(fatal )?error: .*no_such_file.h
// timeout: 30
#include "no_such_file.h" // @here
surface error_include()
{
}
