#include "core/map/finer_vertices.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace fleetplan::core {

FinerVertices::FinerVertices(int first, std::vector<Position> positions, std::vector<Link> links)
    : first_(first), positions_(std::move(positions)), links_(std::move(links)) {
  const std::size_t given = links_.size();
  for (std::size_t k = 0; k < given; ++k) links_.emplace_back(links_[k].second, links_[k].first);
  std::sort(links_.begin(), links_.end());
  links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
  links_.shrink_to_fit();
  blocks_.resize(block_of(first + count()) + 2);
  for (const Link& link : links_) ++blocks_[block_of(link.first) + 1];
  std::partial_sum(blocks_.begin(), blocks_.end(), blocks_.begin());
  by_x_.resize(positions_.size());
  std::iota(by_x_.begin(), by_x_.end(), first);
  std::sort(by_x_.begin(), by_x_.end(), [&](int a, int b) {
    const double difference = position(a).x() - position(b).x();
    return difference != 0.0 ? difference < 0.0 : a < b;
  });
}

std::span<const FinerVertices::Link> FinerVertices::links_from(int vertex) const {
  if (links_.empty()) return {};
  const std::size_t block = block_of(vertex);
  auto begin = links_.begin() + blocks_[block];
  const auto last = links_.begin() + blocks_[block + 1];
  while (begin != last && begin->first < vertex) ++begin;
  auto end = begin;
  while (end != last && end->first == vertex) ++end;
  return {begin, end};
}

std::vector<int> FinerVertices::near(const Position& position, double distance) const {
  std::vector<int> found;
  auto vertex = std::lower_bound(by_x_.begin(), by_x_.end(), position.x() - distance,
                                 [&](int id, double x) { return this->position(id).x() < x; });
  for (; vertex != by_x_.end() && this->position(*vertex).x() <= position.x() + distance; ++vertex) {
    if ((this->position(*vertex) - position).norm() <= distance) found.push_back(*vertex);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace fleetplan::core
