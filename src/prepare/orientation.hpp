// Signs of normals: where they come from, and how they agree where nothing better is done.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"
#include "prepare/point_fits.hpp"
#include "prepare/sampling.hpp"

namespace palpate {

/// Prior evidence for the signs of normals: given normals and a viewpoint.
struct PriorSigns {
  std::span<const Eigen::Vector3f> given;  ///< normals in sorted order, some of them maybe zero or
                                           ///< not finite; empty: none
  std::optional<Eigen::Vector3f> eye;      ///< of the sensor, in the grid's frame, m
  std::optional<Eigen::Vector3d> middle;   ///< of the whole cloud, m; empty: these are all
};

/// The signs that the options allow to be used.
[[nodiscard]] PriorSigns given_signs(const Placed& placed, const Sampling& sampling,
                                     const PrepareOptions& options);

/// Turns normals so that those of neighbours agree: pairs of neighbours whose planes are most
/// parallel join first (Hoppe et al. 1992). Each connected set then faces the side of given normals
/// or of the viewpoint, else outward. For one smooth surface; where surfaces meet or lie close
/// together, refinements do more.
void orient(const Sampling& sampling, const PriorSigns& prior, PointFits& fits);

}  // namespace palpate
