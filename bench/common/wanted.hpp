#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace palpate::bench {

/// Does the name hold one of these parts, or are there none?
[[nodiscard]] inline bool is_wanted(const std::string& name,
                                    const std::vector<std::string>& parts) {
  return parts.empty() || std::ranges::any_of(parts, [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

}  // namespace palpate::bench
