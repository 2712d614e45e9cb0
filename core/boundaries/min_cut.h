// Minimum cuts of small undirected graphs.
#ifndef MARROW_CORE_BOUNDARIES_MIN_CUT_H_
#define MARROW_CORE_BOUNDARIES_MIN_CUT_H_

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace marrow {

// Where a graph between a source and a sink is cut at least cost. Pushes a flow
// over labels of distance, first come first served, and labels anew now and
// then (Goldberg and Tarjan 1988, Cherkassky and Goldberg 1997): on bands of a
// surface that takes little more time the wider they are, where flows along
// shortest paths take a phase for each length. Deterministic. Not thread safe.
class MinCut {
 public:
  enum class Side { kSource, kSink, kNeither };

  explicit MinCut(uint32_t num_nodes);

  // Costs at least 0; several edges between two nodes add up.
  void Connect(uint32_t a, uint32_t b, double cost);
  void ConnectToSource(uint32_t node, double cost);
  void ConnectToSink(uint32_t node, double cost);

  // The side of each node; of all cuts of least cost, the one whose source side
  // is smallest. kNeither where neither terminal can be reached through edges.
  std::vector<Side> Solve();

 private:
  struct Edge {
    std::array<uint32_t, 2> ends;
    std::array<double, 2> room;  // from the first to the second, and back
  };
  struct Arc {
    uint32_t to;
    uint32_t back;  // the arc that goes back
    double room;    // for more flow
  };

  void Add(const Edge& edge);
  void Sort();
  void LabelAll();
  void Discharge(uint32_t node);
  void Lift(uint32_t node);
  void Push(uint32_t node, uint32_t arc);
  std::vector<bool> TouchSink() const;

  uint32_t source_, sink_;
  double least_room_ = 0;
  std::vector<Edge> edges_;
  // Those that leave node u: first_[u] up to first_[u + 1].
  std::vector<Arc> arcs_;
  std::vector<uint32_t> first_;
  // Steps to the source over arcs with room, at least.
  std::vector<uint32_t> label_;
  std::vector<uint32_t> next_;  // the first arc worth a look
  std::vector<double> excess_;
  std::deque<uint32_t> active_;  // nodes with excess, each once
  uint32_t lifts_ = 0;           // since all were labelled
};

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_MIN_CUT_H_
