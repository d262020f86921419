#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace limn {

/// Points of the unit cube sorted into cubic cells, only those that hold points kept. Two points closer than a cell's
/// side are in the same cell or in neighbouring ones.
class PointCells {
 public:
  /// `side` of a cell is made at least 2^-20.
  PointCells(std::span<const glm::vec3> points, float side);

  uint32_t cellCount() const { return uint32_t(m_start.size()) - 1; }
  /// Indices of points, cell by cell, ascending within a cell.
  const std::vector<uint32_t>& order() const { return m_order; }
  /// Places in order() of the points of a cell.
  uint32_t begin(uint32_t cell) const { return m_start[cell]; }
  uint32_t end(uint32_t cell) const { return m_start[cell + 1]; }
  /// Mean number of points in the cell of a point.
  double crowding() const;
  /// Lists of the cells round each cell, itself included; after this neighbours() may be called.
  void findNeighbours();
  std::span<const uint32_t> neighbours(uint32_t cell) const {
    return std::span(m_neighbours).subspan(m_neighbourStart[cell], m_neighbourStart[cell + 1] - m_neighbourStart[cell]);
  }

 private:
  void sortCells(std::vector<uint32_t>& cellOf, std::vector<uint32_t>& counts);
  uint32_t find(uint64_t key) const;

  std::vector<uint32_t> m_table;  ///< open addressing: cell, or empty
  std::vector<uint64_t> m_keys;   ///< of the cells
  std::vector<uint32_t> m_order, m_start, m_neighbours, m_neighbourStart;
};

}  // namespace limn
