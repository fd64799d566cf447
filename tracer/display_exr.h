// SPDX-License-Identifier: Apache-2.0
// Private to the OpenEXR files of this module: an output stream into a base::OutputFile. OpenEXR
// reports by exceptions; both users catch them in the function that calls the library.
#pragma once

#include "runtime/base/output_file.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>

#include <cstdint>
#include <stdexcept>

namespace trace {

class ExrStream : public Imf::OStream {
public:
    explicit ExrStream(base::OutputFile& file) : Imf::OStream(file.path().c_str()), file_(file) {}
    void write(const char bytes[], int count) override {
        if (!file_.write(bytes, static_cast<std::size_t>(count))) {
            throw std::runtime_error("write failed");
        }
    }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t position) override {
        if (!file_.seek(position)) {
            throw std::runtime_error("seek failed");
        }
    }

private:
    base::OutputFile& file_;
};

} // namespace trace
