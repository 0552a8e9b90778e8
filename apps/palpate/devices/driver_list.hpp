#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/base/driver_info.hpp"

namespace palpate::app {

/// Shows drivers with their devices, or what they miss; a driver that is available is followed by
/// what `state_of` says of it.
void print_drivers(const std::vector<DriverInfo>& drivers, std::FILE* stream,
                   const std::function<std::string(const DriverInfo&)>& state_of);

/// How many devices a driver has found; `word`: what they are.
[[nodiscard]] std::string found_by(const DriverInfo& driver, std::string_view word);

/// The same as data, to a file or, as "-", to standard output.
void write_drivers(const std::vector<DriverInfo>& drivers, const std::string& path);

}  // namespace palpate::app
