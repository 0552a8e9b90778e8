// What becomes of a point (docs/method.md 7.3) as one pure function.
#pragma once

#include <cstdint>

#include "stream/moving_points.hpp"

namespace palpate {

/// The fate of an old point of a morphing surface.
enum class Fate : std::uint8_t {
  update,   ///< goes to where its block shows the surface now
  confirm,  ///< is seen where it was
  retain,   ///< stays for a while, as nothing shows where it is
  hide,     ///< stays behind what hides it, and fades slowly
  go,       ///< has been seen through, and fades quickly
  remove,   ///< loses its weight in this frame
};

/// All that a point's fate depends on.
struct FateFacts {
  EntryKind kind = EntryKind::live;
  bool shown = false;   ///< its block shows a surface that can be trusted
  bool same = false;    ///< that surface is the point's own
  bool vouched = true;  ///< and it is within R of the point, or enough neighbours show it, too
  float beyond = 0;     ///< how far the point lies behind that surface, along the camera's axis, m
  float radius = 0;     ///< R of that surface there, m
  /// The point lies more than R behind that surface, and the block remembers no other hidden one.
  bool may_hide = false;
  bool second = false;  ///< the block holds another live point already
};

/// Share of R: a supposed point that lies farther behind what its block shows is not that
/// (judgement: half of what makes one).
inline constexpr float kClearlyBehind = 0.5f;

/// Total: every combination of facts has a fate.
[[nodiscard]] constexpr Fate fate(const FateFacts& facts) {
  const EntryKind kind = facts.kind;
  if (!facts.shown) {
    if (kind == EntryKind::going) return Fate::go;
    return kind == EntryKind::removed || facts.second ? Fate::remove : Fate::retain;
  }
  if (facts.same) return facts.vouched ? Fate::update : Fate::confirm;
  if (kind == EntryKind::out_of_range) return Fate::retain;
  // A plane that is hidden by about R goes on in some frames and not in others.
  if (kind == EntryKind::supposed && facts.beyond > kClearlyBehind * facts.radius)
    return Fate::retain;
  const bool within = -facts.radius <= facts.beyond && facts.beyond <= facts.radius;
  if (kind == EntryKind::removed || within) return Fate::remove;
  const bool hidden = kind != EntryKind::going && facts.beyond > 0 && facts.may_hide;
  return hidden ? Fate::hide : Fate::go;
}

}  // namespace palpate
