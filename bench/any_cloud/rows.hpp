#pragma once

#include <vector>

#include "any_cloud/hostile_scene.hpp"

namespace palpate::any_cloud {

/// Each adds the rows of some families.
void add_flat_rows(std::vector<Row>& rows);       ///< noise, density, hole, duplicate
void add_thin_rows(std::vector<Row>& rows);       ///< plate, rim, gap
void add_folded_rows(std::vector<Row>& rows);     ///< wedge, ridge, box, corners, tee
void add_round_rows(std::vector<Row>& rows);      ///< flip, small, rod, wire, post
void add_closed_rows(std::vector<Row>& rows);     ///< closed, loop
void add_seen_rows(std::vector<Row>& rows);       ///< partial
void add_scattered_rows(std::vector<Row>& rows);  ///< volume, stray
void add_worked_rows(std::vector<Row>& rows);     ///< worked: reliefs, threads, springs, ...
void add_sampled_rows(std::vector<Row>& rows);    ///< sampled: doubles, slices, outliers, ...
void add_ringed_rows(std::vector<Row>& rows);     ///< rings: what a spinning lidar sees

/// All of them, family by family.
[[nodiscard]] std::vector<Row> all_rows();

}  // namespace palpate::any_cloud
