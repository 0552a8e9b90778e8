// Declares the fuzz targets.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string_view>

#include "palpate/io/files.hpp"

namespace palpate::fuzz {

/// The readers that are fuzzed; each has its seeds in corpus/NAME.
[[nodiscard]] std::span<const std::string_view> target_names();

/// Gives `bytes` to the reader of that name. An Error is a fair answer; so is a cloud, if it keeps
/// the promises of PointCloud and survives being written and read again.
/// @throws std::logic_error for a broken promise.
void run_target(std::string_view name, std::span<const std::byte> bytes);

/// @throws std::logic_error for a broken promise.
inline void expect(bool promise, const char* name) {
  if (!promise) throw std::logic_error(name);
}

/// The targets of what devices and remote cameras send. @return whether `name` is one of them
[[nodiscard]] bool run_device_target(std::string_view name, std::span<const std::byte> bytes);

/// The target "cdr": messages of every type of ours. @throws std::logic_error for a broken promise.
void check_messages(std::span<const std::byte> bytes);

/// The target "potree": a store whose files follow one another in `bytes`, behind the sizes of the
/// first two (16 bits each). @throws std::logic_error for a broken promise.
[[nodiscard]] CloudFile read_potree(std::span<const std::byte> bytes);

/// The targets "las" and "laz" as a store reads them. @throws std::logic_error in the same way.
void check_pieces(std::span<const std::byte> bytes);

}  // namespace palpate::fuzz
