#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>

#include "apps/palpate/sources/cloud_facts.hpp"
#include "apps/palpate/sources/load.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::app {

/// Everything that `palpate info` tells of one cloud.
struct InfoReport {
  LoadedCloud loaded;
  Box bounds;
  Box core;  ///< without stray points
  UnitsGuess units;
  SpacingFacts spacing;
  PrepareReport prepared;  ///< with the defaults: the advice
  double rim = 0;          ///< share of points at a border or a hole

  OrganisedFrame organised;  ///< of a cloud with rows and columns
  SourceState image;         ///< felt as that frame; depth 0: it is not
  double image_radius = 0;   ///< R then, median, m
};

void print_report(const InfoReport& report, std::FILE* stream);
[[nodiscard]] nlohmann::ordered_json json_report(const InfoReport& report);

}  // namespace palpate::app
