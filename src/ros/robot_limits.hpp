// What the sources of a robot's guide share: reasons that are reported, and limits.
#pragma once

#include <array>
#include <limits>
#include <string_view>

namespace palpate::ros {

using Reason = std::string_view;

// In the order of Seen::Verdict.
inline constexpr std::array<Reason, 5> kReasons = {
    "no camera sees where the tool is", "nothing is measured where the tool is",
    "the tool is behind what a camera sees", "",
    "a camera that looks where the tool is shows nothing new"};
inline constexpr Reason kBehind = kReasons[2];

// s that hand and tool are free before it starts, so that a hand that passes does not start it;
// after a shorter loss of sight it goes on at once (judgement; 5 Hz with two frames lost in a row:
// 0.4 s)
inline constexpr double kFreeFor = 0.5;
// m that a surface comes nearer in one frame; a hand or tool in between is thicker (judgement)
inline constexpr double kJump = 0.01;
inline constexpr double kStays = 1;  // s; frames of working cameras are younger (judgement)
// Steps to the front for one frame: each leaves r^2 / 2 D of a ball's rim (judgement).
inline constexpr int kTries = 3;
inline constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace palpate::ros
