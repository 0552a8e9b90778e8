// Lists the rows of all families.
#include "any_cloud/rows.hpp"

namespace palpate::any_cloud {

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  add_flat_rows(rows);
  add_thin_rows(rows);
  add_folded_rows(rows);
  add_round_rows(rows);
  add_closed_rows(rows);
  add_seen_rows(rows);
  add_scattered_rows(rows);
  add_worked_rows(rows);
  add_sampled_rows(rows);
  add_ringed_rows(rows);
  return rows;
}

}  // namespace palpate::any_cloud
