// Extrema of a load that is a result (a load factor, the pressure of a given volume): limit points.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/run/run.hpp"

namespace langer {

struct TurningPoint {
  std::string name, unit;
  double t = 0, value = 0;
  bool greatest = false;
  std::string words() const;
};

class TurningPoints {
 public:
  // One step after the other. kinks: t where a given history turns
  void take(const StepRecord& record, const std::vector<double>& kinks);
  const std::vector<TurningPoint>& found() const { return found_; }

 private:
  struct Sample {
    double t = 0, value = 0;
  };
  std::map<std::string, std::vector<Sample>> last_two_;  // by name
  std::vector<TurningPoint> found_;
};

bool kink_between(const std::vector<double>& kinks, double from, double to);

}  // namespace langer
