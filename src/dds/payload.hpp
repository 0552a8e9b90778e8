#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate::dds {

/// The DDS type of that name whose values are encoded bytes that nobody looks into: one code for
/// every message, without a description of types on the wire, so that types match by name as they
/// do in ROS 2. For dds_create_topic_sertype(), which takes it over.
[[nodiscard]] ddsi_sertype* make_type(const std::string& dds_name);

/// A value of such a type, for dds_writecdr(), which takes it over. `bytes`: with their CDR head.
[[nodiscard]] ddsi_serdata* make_payload(const ddsi_sertype* type,
                                         std::span<const std::uint8_t> bytes);

/// The bytes of a value that was received, as long as it is held.
[[nodiscard]] std::span<const std::uint8_t> bytes_of(const ddsi_serdata* value);

/// Its writer counts its messages from 1 on; 0: unknown, as of a writer in this process.
[[nodiscard]] std::uint64_t number_of(const ddsi_serdata* value);

}  // namespace palpate::dds
