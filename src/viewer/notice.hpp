#pragma once

#include <string>

#include "palpate/viewer/viewer.hpp"

namespace palpate::viewer {

/// Something that a person should know now.
struct Notice {
  NoticeLevel level = NoticeLevel::info;
  std::string text;

  bool operator==(const Notice&) const = default;
};

}  // namespace palpate::viewer
