#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/geometry/disk_motion.h"
#include "core/geometry/position.h"

namespace fleetplan::core {

/// The map divided into square buckets. Finds the buckets that a line crosses, and the buckets that a moving
/// disk comes near.
class BucketGrid {
 public:
  BucketGrid(double width, double height, double bucket_size)
      : size_(bucket_size),
        columns_(std::max(1, static_cast<int>(std::ceil(width / bucket_size)))),
        rows_(std::max(1, static_cast<int>(std::ceil(height / bucket_size)))) {}

  std::size_t count() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }

  std::size_t at(const Position& p) const { return index(column_of(p.x()), row_of(p.y())); }

  /// Calls visit(bucket, enter, exit) for the buckets that the segment crosses, in order. `enter` and `exit`
  /// are fractions of its length. Stops and returns false when visit returns false; otherwise returns true.
  template <class Visitor>
  bool walk(const Position& from, const Position& to, Visitor&& visit) const {
    int column = column_of(from.x());
    int row = row_of(from.y());
    const int last_column = column_of(to.x());
    const int last_row = row_of(to.y());
    const Position d = to - from;
    const int column_step = last_column > column ? 1 : -1;
    const int row_step = last_row > row ? 1 : -1;
    constexpr double kNever = 2.0;
    double enter = 0.0;
    while (true) {
      const double x = column == last_column ? kNever : crossing(column + (column_step > 0), from.x(), d.x());
      const double y = row == last_row ? kNever : crossing(row + (row_step > 0), from.y(), d.y());
      const double exit = std::min({x, y, 1.0});
      if (!visit(index(column, row), enter, exit)) return false;
      if (column == last_column && row == last_row) return true;
      if (x < y) {
        column += column_step;
      } else {
        row += row_step;
      }
      enter = exit;
    }
  }

  /// Calls visit(bucket, t_begin, t_end) for every bucket that the disk's centre comes within `reach` of. The
  /// time window contains all such times. `reach` may be exceeded by up to half a bucket's diagonal.
  template <class Visitor>
  void cover(const MovingDisk& disk, double reach, Visitor&& visit) const {
    // The bucket's circumscribed circle, rounded up. Times assume the mean speed.
    const double margin = reach + disk.sag() + 0.7072 * size_;
    const double speed = disk.velocity.norm();
    const bool moving = speed > 0.0;
    const Position a = disk.from;
    const Position b = moving ? disk.at(disk.t_end) : a;
    const Position direction = moving ? Position(disk.velocity / speed) : Position(1.0, 0.0);
    const double length = moving ? (b - a).norm() : 0.0;
    const auto [y_min, y_max] = std::minmax(a.y(), b.y());
    // Bounded: the buckets along one move.
    for (int row = row_of(y_min - margin); row <= row_of(y_max + margin); ++row) {
      const double y = (row + 0.5) * size_;
      const auto [x_min, x_max] = span_near(a, b, y, margin);
      for (int column = column_of(x_min - margin); column <= column_of(x_max + margin); ++column) {
        const Position q = Position((column + 0.5) * size_, y) - a;
        const double along = q.dot(direction);
        const double beside = cross_product(q, direction);
        const double beyond = along < 0.0 ? along : std::max(0.0, along - length);
        if (beside * beside + beyond * beyond > margin * margin) continue;
        if (!moving) {
          visit(index(column, row), disk.t_start, disk.t_end);
          continue;
        }
        const double half = std::sqrt(margin * margin - beside * beside);
        visit(index(column, row), std::max(disk.t_start, disk.t_start + (along - half) / speed),
              std::min(disk.t_end, disk.t_start + (along + half) / speed));
      }
    }
  }

 private:
  struct Span {
    double min;
    double max;
  };

  int column_of(double x) const {
    return std::clamp(static_cast<int>(std::floor(x / size_)), 0, columns_ - 1);
  }
  int row_of(double y) const { return std::clamp(static_cast<int>(std::floor(y / size_)), 0, rows_ - 1); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  /// The fraction of the segment at which it crosses grid line number `border`.
  double crossing(int border, double from, double delta) const {
    return std::clamp((border * size_ - from) / delta, 0.0, 1.0);
  }
  /// The x range of the part of a-b whose y is within `margin` of `y`.
  static Span span_near(const Position& a, const Position& b, double y, double margin) {
    const double dy = b.y() - a.y();
    double f = 0.0;
    double g = 1.0;
    if (dy != 0.0) {
      f = std::clamp((y - margin - a.y()) / dy, 0.0, 1.0);
      g = std::clamp((y + margin - a.y()) / dy, 0.0, 1.0);
    }
    const double x_f = a.x() + f * (b.x() - a.x());
    const double x_g = a.x() + g * (b.x() - a.x());
    return {std::min(x_f, x_g), std::max(x_f, x_g)};
  }

  double size_;
  int columns_;
  int rows_;
};

}  // namespace fleetplan::core
