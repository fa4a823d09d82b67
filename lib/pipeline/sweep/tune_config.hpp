// Config of tune, which draws work-precision diagrams. `axes` and `members` are written by plan.
//
// The error of a level is the difference from a reference, and the reference must be more accurate
// than all levels. Three kinds are possible: a member with a much finer mesh, the extrapolation of
// several members with a known order of convergence, or Richardson's extrapolation of three
// members.
#pragma once

#include "pipeline/sweep/gather_config.hpp"

namespace langer {

// Three members with a constant ratio of mesh sizes, for Richardson's extrapolation.
struct RichardsonConfig {
  std::vector<std::string> coarse, middle, fine;
  double ratio = 2;
  static void fields(auto& v) {
    v(&RichardsonConfig::coarse, "coarse", unit::none,
      "values on the axes of the coarsest of three members", required);
    v(&RichardsonConfig::middle, "middle", unit::none, "... of the next", required);
    v(&RichardsonConfig::fine, "fine", unit::none, "... of the finest", required);
    v(&RichardsonConfig::ratio, "ratio", unit::none, "of the mesh sizes from one to the next",
      Range{1, 100, false, true});
  }
};

// A member with its mesh size.
struct MemberOfLength {
  std::vector<std::string> member;
  double length = 0;
  static void fields(auto& v) {
    v(&MemberOfLength::member, "member", unit::none, "values on the axes of the member", required);
    v(&MemberOfLength::length, "length", unit::none, "its mesh size, in any unit", required,
      positive);
  }
};

// The limit f of q = f + A h^p, fitted to members with several mesh sizes h.
struct FittedLimit {
  std::vector<MemberOfLength> members;
  double order = 2;
  static void fields(auto& v) {
    v(&FittedLimit::members, "members", unit::none, "three or more, with different mesh sizes",
      required);
    v(&FittedLimit::order, "order", unit::none, "order of convergence: power of the mesh size",
      Range{0, 10, false, true});
  }
  // A line through two points has no residual, so the uncertainty of its limit would be unknown.
  std::vector<Complaint> complaints() const {
    if (members.size() < 3)
      return {{"members", std::to_string(members.size()) + " members",
               "three or more: two are always on a line", ""}};
    for (const MemberOfLength& m : members)
      if (m.length != members[0].length) return {};
    return {{"members", "one mesh size", "different mesh sizes", ""}};
  }
};

// The reference value that errors are computed from: one of the three keys.
struct TuneReference {
  std::vector<std::string> member;
  std::optional<FittedLimit> fitted;
  std::optional<RichardsonConfig> richardson;
  static void fields(auto& v) {
    v(&TuneReference::member, "member", unit::none,
      "values on the axes of the member that is the reference; it is not a level itself");
    v(&TuneReference::fitted, "fitted", unit::none,
      "or the limit f of q = f + A length^order, fitted to members");
    v(&TuneReference::richardson, "richardson", unit::none,
      "or the limit of three members, with the order of convergence that they show");
  }
  // Exactly one of the three keys.
  std::vector<Complaint> complaints() const {
    const int given = !member.empty() + fitted.has_value() + richardson.has_value();
    if (given == 1) return {};
    std::string found = "more than one of member, fitted and richardson";
    if (given == 0) found = "nothing";
    return {{"", found, "one of the three", ""}};
  }
};

// The config of tune.
struct TuneConfig {
  std::vector<std::string> quantities;
  TuneReference reference;
  std::vector<double> wanted{5, 2, 1, 0.5, 0.2};
  std::string title;
  FigureStyle figure_style;
  std::vector<GatherAxis> axes;
  std::vector<GatherMember> members;
  static void fields(auto& v) {
    v(&TuneConfig::quantities, "quantities", unit::none,
      "names of the members' summaries whose errors matter", required);
    v(&TuneConfig::reference, "reference", unit::none, "the value that errors are relative to",
      required);
    v(&TuneConfig::wanted, "wanted", unit::none,
      "errors in percent for which the cheapest level is printed");
    v(&TuneConfig::title, "title", unit::none, "above the pictures");
    v(&TuneConfig::figure_style, "figure_style", unit::none, "style of the pictures");
    v(&TuneConfig::axes, "axes", unit::none,
      "axes of the sweep, in which the levels differ; written by plan");
    v(&TuneConfig::members, "members", unit::none,
      "one per file, in the same order; written by plan");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (quantities.empty())
      found.push_back({"quantities", "an empty list", "at least one name, such as force", ""});
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!(wanted[i] > 0))
        found.push_back({"wanted[" + std::to_string(i) + "]", "not above 0", "percent", ""});
    return found;
  }
};

}  // namespace langer
