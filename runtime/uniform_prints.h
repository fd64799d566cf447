// SPDX-License-Identifier: Apache-2.0
// printf of uniform values prints once per execution of the statement, whatever the width of
// packets (lib-009). In: the text of every packet that executed it. Out: whether it is new. Under
// one batch the statement was executed as often as the packet says that executed it most often.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

namespace rt {

class UniformPrints {
public:
    // first: of the packet, below SL_BATCH_MAX.
    bool is_new(std::uint32_t first, std::string_view text) {
        Count& count = counts_[std::string(text)];
        std::uint32_t& of_packet = count.of_packet[first / min_lanes % max_packets];
        if (++of_packet <= count.printed) {
            return false;
        }
        ++count.printed;
        return true;
    }
    void clear() { counts_.clear(); }

private:
    static constexpr std::uint32_t min_lanes = 4, max_packets = SL_BATCH_MAX / min_lanes;
    struct Count {
        std::uint32_t printed = 0;
        std::array<std::uint32_t, max_packets> of_packet{};
    };
    std::unordered_map<std::string, Count> counts_;
};

} // namespace rt
