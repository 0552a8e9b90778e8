#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// Do the environment's locales exist?
[[nodiscard]] Finding check_locales(const System& system);

/// Are numbers written with a decimal comma?
[[nodiscard]] Finding check_decimal_point(const System& system);

/// Do point clouds that come over the network as datagrams fit into the kernel's buffer?
[[nodiscard]] Finding check_network_buffer(const System& system);

/// Is there a folder for the remote device's socket?
[[nodiscard]] Finding check_runtime_folder(const System& system);

/// Are pictures drawn?
[[nodiscard]] Finding check_matplotlib(const System& system);

/// Does a browser open for the page?
[[nodiscard]] Finding check_browser(const System& system);

/// Are the files there that other findings' commands copy?
[[nodiscard]] Finding check_installation(const System& system);

}  // namespace palpate::app::doctor
