#include "core/reservation/contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// A distance is reduced by this fraction before it is kept, so that rounding does not forbid to stay.
constexpr double kRounding = 1e-14;

bool is_at_start(Terminal terminal) { return terminal == Terminal::start || terminal == Terminal::leaving; }

}  // namespace

struct Contacts::Point {
  Position position;
  std::size_t robot;
  Terminal terminal;
  double radius;
  double rounding;
  double inflation;
  bool grows = false;
};

Contacts::Contacts(std::vector<Terminals> robots, bool with_margin)
    : robots_(std::move(robots)),
      with_margin_(with_margin),
      contacts_(robots_.size()),
      too_many_(robots_.size(), false) {
  std::vector<Point> points;
  double largest = 0.0;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const Terminals& robot = robots_[i];
    points.push_back({.position = robot.start,
                      .robot = i,
                      .terminal = Terminal::start,
                      .radius = robot.pair_radius,
                      .rounding = robot.start_rounding,
                      .inflation = robot.inflation,
                      .grows = robot.grows_at_start});
    largest = std::max(largest, robot.pair_radius);
    if (!robot.goal) continue;
    const double at_goal = robot.pair_radius + (robot.radius_at_goal - robot.radius_at_start);
    points.push_back({.position = *robot.goal,
                      .robot = i,
                      .terminal = Terminal::goal,
                      .radius = at_goal,
                      .rounding = robot.goal_rounding,
                      .inflation = robot.inflation});
    largest = std::max(largest, at_goal);
  }
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.position.x() < b.position.x(); });
  // Bounded: pairs of the robots of a request, which takes at most 10 ms for 2000.
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double reach = points[i].radius + largest;
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      if (points[j].position.x() - points[i].position.x() > reach) break;
      compare(points[i], points[j]);
    }
  }
}

void Contacts::compare(const Point& a, const Point& b) {
  if (a.robot == b.robot) return;
  const double sum = a.radius + b.radius;
  if (std::abs(a.position.y() - b.position.y()) > sum) return;
  const double distance = (a.position - b.position).norm() - a.rounding - b.rounding;
  const double kept = distance * (1.0 - kRounding);
  if (kept >= sum - kSearchSlack) return;
  if (a.terminal == Terminal::start && b.terminal == Terminal::start) {
    constexpr double kContact = kContactTolerance + 4.0 * kSamePosition;
    const bool overlapping = distance < sum - a.inflation - b.inflation - kContact;
    if (overlapping && (a.grows || b.grows)) return;
    const bool in_turn = overlapping || (with_margin_ && distance < sum - kContact);
    add(a.robot, {b.robot, kept, kForever, in_turn});
    add(b.robot, {a.robot, kept, kForever, in_turn});
  } else if (distance >= sum - kContactTolerance - 4.0 * kSamePosition) {
    add(a.robot, {b.robot, kForever, kept, false});
    add(b.robot, {a.robot, kForever, kept, false});
  }
}

void Contacts::add(std::size_t robot, const Contact& contact) {
  if (too_many_[robot]) return;
  std::vector<Contact>& all = contacts_[robot];
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const Contact& c) { return c.other == contact.other; });
  if (known != all.end()) {
    known->leaving = std::min(known->leaving, contact.leaving);
    known->touching = std::min(known->touching, contact.touching);
    known->in_turn = known->in_turn || contact.in_turn;
  } else if (all.size() < kMaxContacts) {
    all.push_back(contact);
  } else {
    too_many_[robot] = true;
  }
}

/// Looks in the lists of both robots, because one may have too many contacts to list the other one.
const Contacts::Contact* Contacts::find(std::size_t robot, std::size_t other) const {
  // Bounded: kMaxContacts of each of the two.
  for (const auto& [of, with] : {std::pair{robot, other}, std::pair{other, robot}}) {
    for (const Contact& contact : contacts_[of]) {
      if (contact.other == with) return &contact;
    }
    if (!too_many_[of]) return nullptr;
  }
  return nullptr;
}

bool Contacts::empty() const {
  return std::all_of(contacts_.begin(), contacts_.end(),
                     [](const auto& contacts) { return contacts.empty(); });
}

std::vector<std::size_t> Contacts::at_start(std::size_t robot) const {
  std::vector<std::size_t> others;
  for (const Contact& contact : contacts_[robot]) {
    if (contact.leaving < kForever) others.push_back(contact.other);
  }
  std::sort(others.begin(), others.end());
  return others;
}

double Contacts::deficit(std::size_t robot) const {
  double deficit = 0.0;
  for (const Contact& contact : contacts_[robot]) {
    const double sum = robots_[robot].pair_radius + robots_[contact.other].pair_radius;
    deficit = std::max(deficit, sum - contact.leaving);
  }
  return deficit;
}

bool Contacts::leaves_in_turn(std::size_t robot) const {
  return too_many_[robot] || std::any_of(contacts_[robot].begin(), contacts_[robot].end(),
                                         [](const Contact& contact) { return contact.in_turn; });
}

Terminal Contacts::terminal(std::size_t robot, const Segment& path, double radius, bool has_left) const {
  if (none(robot)) return Terminal::none;
  const Terminals& ends = robots_[robot];
  if (!has_left && radius == ends.radius_at_start && is_same_position(path.from, ends.start)) {
    const bool moves = path.from != path.to;
    return moves && leaves_in_turn(robot) ? Terminal::leaving : Terminal::start;
  }
  const bool at_goal = ends.goal && radius == ends.radius_at_goal && is_same_position(path.to, *ends.goal);
  return at_goal ? Terminal::goal : Terminal::none;
}

double Contacts::distance(std::size_t robot, Terminal at, std::size_t other, Terminal other_at,
                          double full) const {
  if (at == Terminal::none || other_at == Terminal::none) return full;
  const Contact* contact = find(robot, other);
  if (contact == nullptr) return full;
  if (at == Terminal::leaving && other_at == Terminal::leaving && contact->in_turn) return full;
  const bool leaving = is_at_start(at) && is_at_start(other_at);
  return std::min(full, leaving ? contact->leaving : contact->touching);
}

}  // namespace fleetplan::core
