// SPDX-License-Identifier: Apache-2.0
#include "tracer/run_record.h"

#include <algorithm>
#include <fstream>
#include <sys/utsname.h>
#include <thread>
#include <unistd.h>

namespace trace {

namespace {

// "model name : ..." of the first processor; Linux only.
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

std::string system_name() {
    utsname name{};
    return uname(&name) == 0 ? std::string(name.sysname) + " " + name.release + " " + name.machine
                             : std::string("unknown");
}

} // namespace

Machine this_machine() {
    Machine machine;
    machine.processor = processor_name();
    machine.system = system_name();
    machine.num_threads = std::max(std::thread::hardware_concurrency(), 1U);
    const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGE_SIZE);
    machine.memory_bytes =
        pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size)
                              : 0;
    return machine;
}

FrameOptions frame_options(const rib::Options& options) {
    FrameOptions out;
    out.resolution[0] = options.xres, out.resolution[1] = options.yres;
    out.samples[0] = options.xsamples, out.samples[1] = options.ysamples;
    out.pixel_aspect = options.pixel_aspect;
    std::copy(options.crop.begin(), options.crop.end(), out.crop);
    out.shutter[0] = options.shutter_open, out.shutter[1] = options.shutter_close;
    std::copy(std::begin(options.filter_width), std::end(options.filter_width), out.filter_width);
    out.gain = options.gain, out.gamma = options.gamma;
    out.filter = options.filter;
    out.projection = options.projection;
    out.hider = options.hider;
    for (const rib::Display& d : options.displays) {
        out.displays.push_back({d.name, d.type, d.mode});
    }
    return out;
}

} // namespace trace
