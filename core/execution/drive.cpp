#include "core/execution/drive.h"

#include <algorithm>

namespace fleetplan::core {

namespace {

/// Times that differ by less are the same, seconds: no piece is divided into shorter ones.
constexpr double kSameMoment = 1e-8;

/// Changes of speed, and cruises, that are shorter, as a share of their part, are rounding.
constexpr double kNoShare = 1e-13;

}  // namespace

std::size_t end_of_drive(Actions actions, std::size_t first) {
  std::size_t last = first;
  while (last + 1 < actions.size() && actions[last].profile->end > 0.0 && actions[last + 1].profile &&
         actions[last + 1].type == actions[last].type) {
    ++last;
  }
  return last + 1;
}

double Drive::Piece::time_at(double place) const {
  if (place >= to || to <= from) return t_end;
  const double covered = std::max(0.0, (place - from) / (to - from));
  return t_start + elapsed_share(covered, ramp()) * (t_end - t_start);
}

Drive::Piece Drive::Piece::until(double t, double place) const {
  const double elapsed = t_end > t_start ? (t - t_start) / (t_end - t_start) : 1.0;
  return {.part = part,
          .t_start = t_start,
          .t_end = t,
          .from = from,
          .to = place,
          .start = start,
          .end = start + elapsed * (end - start)};
}

Drive::Piece Drive::Piece::since(double t, double place) const {
  const double elapsed = t_end > t_start ? (t - t_start) / (t_end - t_start) : 1.0;
  return {.part = part,
          .t_start = t,
          .t_end = t_end,
          .from = place,
          .to = to,
          .start = start + elapsed * (end - start),
          .end = end};
}

Drive::Drive(Actions actions, std::size_t first, const std::vector<double>& factors, double t, double speed,
             double fraction)
    : first_(first), inertia_(actions[first].profile->inertia), begins_{0.0}, t_(t), speed_(speed) {
  const std::size_t end = end_of_drive(actions, first);
  // Bounded: the actions of one robot, each in one drive.
  for (std::size_t k = first; k < end; ++k) {
    const SpeedProfile& profile = *actions[k].profile;
    const auto factor = [&](std::size_t action) {
      return factors.size() > 1 ? factors[action - first] : factors.front();
    };
    LimitedPart part{amount_of(actions[k]), profile.cruise * factor(k)};
    if (k + 1 < end) {
      part.end_limit = std::min(profile.end * factor(k), actions[k + 1].profile->start * factor(k + 1));
    }
    parts_.push_back(part);
    begins_.push_back(begins_.back() + part.length);
  }
  at_ = place_of(first, fraction);
}

double Drive::place_of(std::size_t action, double fraction) const {
  if (action < first_) return 0.0;
  if (action >= end()) return length();
  const std::size_t part = action - first_;
  if (fraction >= 1.0) return begins_[part + 1];
  return begins_[part] + fraction * parts_[part].length;
}

double Drive::fraction(std::size_t part, double place) const {
  if (place >= begins_[part + 1]) return 1.0;
  return std::max(0.0, (place - begins_[part]) / parts_[part].length);
}

void Drive::head_for(double place) {
  pieces_.clear();
  next_ = 0;
  std::vector<LimitedPart> limited;
  std::vector<std::size_t> numbers;
  const auto after = std::upper_bound(begins_.begin() + 1, begins_.end(), at_);
  auto part = static_cast<std::size_t>(after - begins_.begin()) - 1;
  // Bounded: the actions of the drive.
  for (; part < parts_.size() && begins_[part] < place; ++part) {
    const double length = std::min(place, begins_[part + 1]) - std::max(at_, begins_[part]);
    if (length <= 0.0) continue;
    limited.push_back({length, parts_[part].limit, parts_[part].end_limit});
    numbers.push_back(part);
  }
  if (limited.empty()) return;
  const std::vector<SpeedProfile> profiles = fastest_profiles(limited, inertia_, speed_);
  pieces_.reserve(3 * limited.size());
  for (std::size_t k = 0; k < limited.size(); ++k) {
    add_pieces(numbers[k], profiles[k], std::min(place, begins_[numbers[k] + 1]));
  }
}

void Drive::add_pieces(std::size_t part, const SpeedProfile& profile, double to) {
  const double from = pieces_.empty() ? at_ : pieces_.back().to;
  const double rise = profile.rise_length();
  const double fall = profile.fall_length();
  const double cruise = to - from - rise - fall;
  const double least = kNoShare * (to - from);
  const bool cruises = cruise > least;
  const bool falls = fall > least;
  if (rise > least) {
    add_piece(part, profile.rise_time(), cruises || falls ? from + rise : to, profile.start, profile.cruise);
  }
  if (cruises) {
    add_piece(part, cruise / profile.cruise, falls ? to - fall : to, profile.cruise, profile.cruise);
  }
  if (falls) add_piece(part, profile.fall_time(), to, profile.cruise, profile.end);
}

void Drive::add_piece(std::size_t part, double seconds, double to, double start, double end) {
  const double from = pieces_.empty() ? at_ : pieces_.back().to;
  const double t = pieces_.empty() ? t_ : pieces_.back().t_end;
  pieces_.push_back(
      {.part = part, .t_start = t, .t_end = t + seconds, .from = from, .to = to, .start = start, .end = end});
}

double Drive::time_at(double place) const {
  const auto piece = std::lower_bound(ahead(), pieces_.cend(), place,
                                      [](const Piece& one, double sought) { return one.to < sought; });
  if (piece != pieces_.cend()) return piece->time_at(place);
  return stands() ? t_ : pieces_.back().t_end;
}

std::vector<DrivenPiece> Drive::drive_to(double place) { return take(time_at(place), place); }

std::vector<DrivenPiece> Drive::drive_until(double t) {
  const auto piece = std::lower_bound(ahead(), pieces_.cend(), t,
                                      [](const Piece& one, double time) { return one.t_end < time; });
  if (piece == pieces_.cend()) return drive_to(heading_for());
  if (t <= piece->t_start) return take(t, piece->from);
  const double elapsed = (t - piece->t_start) / (piece->t_end - piece->t_start);
  return take(t, piece->from + covered_share(elapsed, piece->ramp()) * (piece->to - piece->from));
}

std::vector<DrivenPiece> Drive::take(double t, double place) {
  std::vector<DrivenPiece> taken;
  double reached = at_;
  // Bounded: the pieces that are ahead, each taken once.
  while (!stands() && (pieces_[next_].to <= place || pieces_[next_].t_end <= t + kSameMoment)) {
    speed_ = pieces_[next_].end;
    reached = pieces_[next_].to;
    taken.push_back(driven(pieces_[next_++]));
  }
  if (!stands() && pieces_[next_].t_start < t - kSameMoment) {
    Piece& under_way = pieces_[next_];
    taken.push_back(driven(under_way.until(t, place)));
    under_way = under_way.since(t, place);
    speed_ = under_way.start;
  }
  at_ = std::max({at_, place, reached});
  t_ = std::max({t_, t, taken.empty() ? t : taken.back().t_end});
  return taken;
}

DrivenPiece Drive::driven(const Piece& piece) const {
  return {.action = first_ + piece.part,
          .t_start = piece.t_start,
          .t_end = piece.t_end,
          .from = fraction(piece.part, piece.from),
          .to = fraction(piece.part, piece.to),
          .ramp = piece.ramp()};
}

}  // namespace fleetplan::core
