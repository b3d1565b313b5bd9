#include "experiments/trials/table_rows.h"

namespace possibility::experiments {

const std::vector<TableRow>& TableRows() {
  static const std::vector<std::string> one{"walk"}, two{"walk", "crawl"},
      three{"walk", "crawl", "jump"};
  static const std::vector<TableRow> rows = {
      {"three_routes_a_1",
       "Three Routes (a)",
       "three_routes_a",
       one,
       {0.088, 0.048},
       {8.47, 0.81},
       {143.2, 3.5},
       1},
      {"three_routes_a_2",
       "Three Routes (a)",
       "three_routes_a",
       two,
       {0.134, 0.076},
       {8.75, 0.91},
       {143.6, 2.6},
       1},
      {"three_routes_a_3",
       "Three Routes (a)",
       "three_routes_a",
       three,
       {0.484, 0.450},
       {7.52, 1.86},
       {136.8, 10.0},
       1},
      {"three_routes_b_2",
       "Three Routes (b)",
       "three_routes_b",
       two,
       {0.152, 0.112},
       {9.23, 1.09},
       {142.5, 3.2},
       1},
      {"three_routes_b_3",
       "Three Routes (b)",
       "three_routes_b",
       three,
       {0.561, 0.502},
       {7.59, 2.30},
       {134.0, 11.1},
       1},
      {"three_routes_c_3",
       "Three Routes (c)",
       "three_routes_c",
       three,
       {1.210, 0.218},
       {5.73, 1.79},
       {121.2, 7.03},
       1},
      {"hallway_3", "Hallway", "hallway", three, {3.67, 11.52}, {8.29, 0.84}, {127.2, 6.96}, 0.96},
      {"double_jump_3",
       "Double Jump",
       "double_jump",
       three,
       {1.48, 0.34},
       {4.32, 0.28},
       {113.3, 6.24},
       1}};
  return rows;
}

const std::vector<std::string>& InfeasibleTwins() {
  static const std::vector<std::string> twins = {"closed_room", "three_routes_c_infeasible",
                                                 "hallway_infeasible", "double_jump_infeasible"};
  return twins;
}

}  // namespace possibility::experiments
