// SPDX-License-Identifier: Apache-2.0
// Writing pictures: one planned Display and one Image in, one file out (display_formats.def).
//
// Files appear under their final name only when complete. Every failure is a message with the place
// of the Display request and a result; exceptions and longjmp of the libraries stay inside their
// one file each. Source: ri.md 6.4, 9.5; decisions film-005 to film-007.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "runtime/base/mat.h"
#include "tracer/camera.h"
#include "tracer/film.h"
#include "tracer/outputs.h"
#include "tracer/quantize.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trace {

enum class DisplayResult : std::uint8_t {
    Written,
    Skipped, // a driver that writes nothing here (null, framebuffer, shadow ...), or nothing to
             // write
    Failed   // the environment failed: exit code 3
};

// What a file says about the picture besides its pixels.
struct PictureInfo {
    int xres = 0, yres = 0;
    double pixel_aspect = 1;
    base::Mat4 camera_from_world;
    base::Mat4 ndc_from_world; // 0..1 over the whole frame: xres by yres pixels
    // The frame in the plane z = 1 of the camera (orthographic: anywhere): centre, and width in x.
    double window_center[2] = {0, 0}, window_width = 1;
};
[[nodiscard]] PictureInfo picture_info(const Camera& camera);
// To a square from -1 to 1 over the frame, y up: what Pixar's files call worldtoscreen.
[[nodiscard]] base::Mat4 screen_from_world(const PictureInfo& info);

// Writes the image to the file the request names. The image is exposed and has been through the
// imager; its planes are those the plan's `picture` says.
[[nodiscard]] DisplayResult write_display(const DisplayPlan& plan, const Image& image,
                                          const PictureInfo& info, base::Diag& diag);

// The file that write_display() will make; nullopt for drivers that make none.
[[nodiscard]] std::optional<std::string> display_file(const rib::Display& display);
// A display that shows the picture on a screen ("framebuffer"); one that leaves a file.
[[nodiscard]] bool shows_window(const rib::Display& display);
[[nodiscard]] bool leaves_file(const rib::Display& display);
// Its file holds floats whatever Quantize says.
[[nodiscard]] bool keeps_floats(const rib::Display& display);
// The file that keeps the picture of a window: its name, with .tif unless that names a format.
[[nodiscard]] rib::Display file_of_window(const rib::Display& window,
                                          const std::string& default_file);

// The display for `-o FILE`, or for a RIB without Display: format by extension, TIFF without one.
[[nodiscard]] rib::Display default_display(std::string file, std::string mode);

// Displays of type "zfile" and the like: input of MakeShadow rather than pictures.
[[nodiscard]] bool writes_depth_map(const rib::Display& display);

} // namespace trace
