// SPDX-License-Identifier: Apache-2.0
// Counts, ranges and index bounds of primitives (ri.md 10.3 and section 11). What passes may be
// indexed without further checks; what does not is reported and rejected, or loses the parameter at
// fault.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"

#include <optional>
#include <string>
#include <string_view>

namespace rib {

// Items that a parameter of each storage class has. constant: 1.
struct ClassCounts {
    std::size_t uniform = 1, varying = 4, vertex = 4, face_varying = 4;

    [[nodiscard]] std::size_t of(StorageClass storage) const;
};

// Of a shape that passed check_primitive. The basis steps count for bicubic patch meshes (both) and
// curves (v).
[[nodiscard]] ClassCounts class_counts(const Shape& shape, const Basis& basis);

// False: reported, not to be drawn. name: the request, for messages. Surplus values and faulty
// parameters are removed from the list with a message.
[[nodiscard]] bool check_primitive(Primitive& primitive, const Basis& basis, std::string_view name,
                                   base::Diag& diag);

// Whether two samples of a moving primitive differ in numbers only (ri.md 12.3).
[[nodiscard]] bool same_topology(const Primitive& a, const Primitive& b);

// What is wrong with the arrays of a TrimCurve, or "".
[[nodiscard]] std::string trim_curve_fault(const TrimCurve& trim);

} // namespace rib
