// Config of tune. `axes` and `members` are written by plan.
#pragma once

#include "scene/gather_config.hpp"

namespace langer {

struct RichardsonConfig {
  std::vector<std::string> coarse, middle, fine;
  double ratio = 2;
  static void fields(auto& v) {
    v(&RichardsonConfig::coarse, "coarse", unit::none, "values on the axes of the coarsest of three members", required);
    v(&RichardsonConfig::middle, "middle", unit::none, "... of the next", required);
    v(&RichardsonConfig::fine, "fine", unit::none, "... of the finest", required);
    v(&RichardsonConfig::ratio, "ratio", unit::none, "of the lengths of cells from one to the next", Range{1, 100, false, true});
  }
};

struct TuneReference {
  std::vector<std::string> member;
  std::optional<RichardsonConfig> richardson;
  static void fields(auto& v) {
    v(&TuneReference::member, "member", unit::none, "values on the axes of the member that counts as right; it is no rung itself");
    v(&TuneReference::richardson, "richardson", unit::none, "instead: the limit of three members");
  }
  std::vector<Complaint> complaints() const {
    if (member.empty() != !richardson) return {};
    return {{"", member.empty() ? "neither a member nor richardson" : "a member and richardson", "one of the two", ""}};
  }
};

struct TuneConfig {
  std::vector<std::string> quantities;
  TuneReference reference;
  std::vector<double> wanted{5, 2, 1, 0.5, 0.2};
  std::string title;
  std::vector<GatherAxis> axes;
  std::vector<GatherMember> members;
  static void fields(auto& v) {
    v(&TuneConfig::quantities, "quantities", unit::none, "names of the members' summaries whose errors matter", required);
    v(&TuneConfig::reference, "reference", unit::none, "what counts as right", required);
    v(&TuneConfig::wanted, "wanted", unit::none, "errors in percent for which the cheapest rung is told");
    v(&TuneConfig::title, "title", unit::none, "above the pictures");
    v(&TuneConfig::axes, "axes", unit::none, "what tells the rungs apart; written by plan");
    v(&TuneConfig::members, "members", unit::none, "one per file, in the same order; written by plan");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (quantities.empty()) found.push_back({"quantities", "an empty list", "at least one name, such as force", ""});
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!(wanted[i] > 0)) found.push_back({"wanted[" + std::to_string(i) + "]", "not above 0", "percent", ""});
    return found;
  }
};

}  // namespace langer
