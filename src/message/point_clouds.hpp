#pragma once

#include "message/sensor_types.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::message {

/// The points of a message in its frame of reference: any layout of fields, either byte order.
/// Normals, colours ("rgb", "rgba" as PCL packs them) and intensities are kept, points that are not
/// finite dropped; there may be none left. Organised clouds keep their pixels, and are seen from
/// the frame's origin.
/// @throws Error that reports what contradicts itself.
[[nodiscard]] PointCloud cloud_of(const PointCloud2& message);

/// Positions and normals (where `cloud` has them) as float32; the header stays for the caller to
/// set.
[[nodiscard]] PointCloud2 message_of(const PointCloud& cloud);

}  // namespace palpate::message
