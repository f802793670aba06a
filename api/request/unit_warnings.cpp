#include "api/request/unit_warnings.h"

#include <cmath>
#include <cstddef>

#include "api/json/faults.h"

namespace fleetplan::api {

namespace {

/// Numbers of one kind that are larger than usual: how many, and the first of them.
class Unusual {
 public:
  explicit Unusual(double usual) : usual_(usual) {}

  template <typename Name>
  void look_at(double number, const Name& name) {
    if (!(std::abs(number) > usual_)) return;
    if (count_ == 0) first_ = name() + " is " + number_text(number);
    ++count_;
  }
  template <typename Name>
  void look_at(const JsonReader& member, const Name& name) {
    if (member.is_number()) look_at(*member.value().number(), name);
  }

  void tell(std::vector<std::string>& warnings, const std::string& unit, const std::string& advice) const {
    if (count_ == 0) return;
    const std::string others = count_ == 1 ? "" : " (and " + std::to_string(count_ - 1) + " more like it)";
    warnings.push_back("The " + first_ + ' ' + unit + others + advice);
  }

 private:
  double usual_;
  std::size_t count_ = 0;
  std::string first_;
};

}  // namespace

std::vector<std::string> unit_warnings(const std::vector<ReadRobot>& robots, const JsonReader& zones) {
  Unusual headings(kUsualHeading);
  Unusual turning(kUsualAngularSpeed);
  Unusual driving(kUsualLinearSpeed);
  const auto of = [](const char* what, const std::string& id) {
    return [what, &id] { return std::string(what) + in_quotes(id); };
  };
  for (const ReadRobot& read : robots) {
    if (read.start && read.start.stop().met_after(1)) break;
    const std::string& id = read.robot.id;
    headings.look_at(read.start.find("theta"), of("heading at the start of robot ", id));
    for (const JsonReader& goal : read.goals) {
      headings.look_at(goal.find("theta"), of("heading at a goal of robot ", id));
    }
    turning.look_at(read.robot.angular_speed, of("angular speed of robot ", id));
    driving.look_at(read.robot.linear_speed, of("linear speed of robot ", id));
  }
  if (zones && zones.value().is_array()) {
    for (const JsonReader zone : zones.items()) {
      if (zone.stop().met_after(1)) break;
      const std::string id(zone.find("id").string().value_or(""));
      headings.look_at(zone.find("heading"), of("heading of zone ", id));
    }
  }
  std::vector<std::string> warnings;
  headings.tell(warnings, "rad", ", more than a whole turn. Headings are in radians: is it in degrees?");
  turning.tell(warnings, "rad/s", ", more than any robot turns. Is it in degrees per second?");
  driving.tell(warnings, "m/s", ", more than any robot drives. Is it in millimetres per second?");
  return warnings;
}

}  // namespace fleetplan::api
