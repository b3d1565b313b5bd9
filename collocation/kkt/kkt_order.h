#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace possibility::collocation {

/// An off-diagonal entry of a symmetric matrix, with its relative size.
struct KktEdge {
  int row = 0;
  int column = 0;
  double weight = 0;
};

/// The rows of a symmetric indefinite matrix as a graph whose nodes are pairs and single rows. Each
/// of the last `num_dual` rows, which may have a zero diagonal, is paired with its heaviest
/// neighbour among the other rows that is still free, so that the two can serve as one 2x2 pivot
/// (Duff & Pralet 2005). Finds elimination orders that keep pairs together; an order maps position
/// to row.
class KktPairs {
 public:
  /// `times`: by row, its place along time in any unit, NaN if it has none. Empty: none has.
  KktPairs(int size, int num_dual, const std::vector<KktEdge>& edges,
           const std::vector<double>& times);

  /// Approximate minimum degree.
  std::vector<int> OrderByDegree() const;

  /// One instant after the other, rows without a time last: quick, and good where few rows share an
  /// instant. None if no row has a time.
  std::optional<std::vector<int>> OrderByTime() const;

  /// For matrices whose rows couple with those of neighbouring instants only, as transcription
  /// makes them. Separators are found at all instants that no coupling passes over. What lies
  /// between them is eliminated first, by degree, then the separators one after the other, then the
  /// rows without a time. None if there is no separator.
  std::optional<std::vector<int>> OrderAlongTime() const;

 private:
  struct Node {
    int row = 0;
    int partner = -1;
    int instant = -1;  ///< rank of its time; -1: none
  };

  void MakeNodes(int size, const std::vector<int>& partner);
  void Connect(const std::vector<KktEdge>& edges);
  void RankTimes(const std::vector<double>& times);
  void DropFarCouplings();
  std::vector<bool> SeparatingInstants() const;
  std::vector<bool> SeparatingNodes() const;
  std::vector<int> DegreeOrder(const std::vector<int>& nodes) const;
  std::vector<int> RowsOf(const std::vector<int>& nodes) const;

  std::vector<Node> nodes_;
  std::vector<int> node_of_;                      ///< by row
  std::vector<std::pair<int, int>> connections_;  ///< of nodes, each way once or more
  int num_instants_ = 0;
};

}  // namespace possibility::collocation
