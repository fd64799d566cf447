// SPDX-License-Identifier: Apache-2.0
// Private to the module perigee_oiio: OpenImageIO, named here once for its two files.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/texture.h>
