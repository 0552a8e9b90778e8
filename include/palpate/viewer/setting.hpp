#pragma once

#include <string>
#include <variant>
#include <vector>

namespace palpate {

enum class SettingKind {
  number,  ///< from `least` to `most`
  choice,  ///< one of `choices`
  on_off,  ///< a switch
};

/// A number, a choice or a switch.
using SettingValue = std::variant<double, std::string, bool>;

/// Something that a viewer's page may change. The viewer knows no setting of its own: a program
/// offers them (ViewerControls).
struct Setting {
  std::string key;    ///< "stiffness"; unique
  std::string label;  ///< for people
  std::string unit = {};
  SettingKind kind = SettingKind::number;
  double least = 0;  ///< of a number
  double most = 1;
  double step = 0;  ///< that its slider should take; 0: any
  std::vector<std::string> choices = {};
  SettingValue value = 0.0;  ///< the present one, of the kind
};

}  // namespace palpate
