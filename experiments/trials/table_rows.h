#pragma once

#include <string>
#include <vector>

namespace possibility::experiments {

/// A mean with its standard deviation in brackets, as printed.
struct PrintedFigure {
  double mean = 0;
  double std = 0;
};

/// A row of the paper's Table 1 (section "Experimental Results"), times in s.
struct TableRow {
  std::string name;      ///< "three_routes_a_2"
  std::string title;     ///< as the paper prints it
  std::string scenario;  ///< file name without .yaml
  std::vector<std::string> actions;
  PrintedFigure graph, motion, real_time_ratio;
  double success = 1;
};

/// The eight rows in the paper's order.
const std::vector<TableRow>& TableRows();

/// Infeasible scenarios: file names without .yaml.
const std::vector<std::string>& InfeasibleTwins();

}  // namespace possibility::experiments
