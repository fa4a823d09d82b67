// Config of gather. `axes` and `members` are written by plan; by hand they are needed only where axis columns are wanted.
#pragma once

#include <string>
#include <vector>

#include "base/fields.hpp"

namespace langer {

struct GatherAxis {
  std::string name, unit = "-";
  static void fields(auto& v) {
    v(&GatherAxis::name, "name", unit::none, "name of the column", required);
    v(&GatherAxis::unit, "unit", unit::none, "unit of the values; - for words and pure numbers");
  }
};

struct GatherMember {
  std::string path;
  std::vector<std::string> at;
  static void fields(auto& v) {
    v(&GatherMember::path, "path", unit::none, "what the member is called: its file in the run's folder", required);
    v(&GatherMember::at, "at", unit::none, "its value on each axis", required);
  }
};

struct GatherConfig {
  std::vector<std::string> columns;
  std::vector<GatherAxis> axes;
  std::vector<GatherMember> members;
  static void fields(auto& v) {
    v(&GatherConfig::columns, "columns", unit::none,
      "names of /summary in the order wanted; none means all of the first member");
    v(&GatherConfig::axes, "axes", unit::none, "first columns of the table; written by plan");
    v(&GatherConfig::members, "members", unit::none, "one per file gathered, in the same order; written by plan");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> all;
    for (std::size_t i = 0; i < members.size(); ++i)
      if (members[i].at.size() != axes.size())
        all.push_back({"members[" + std::to_string(i) + "].at", "found " + std::to_string(members[i].at.size()) + " values",
                       "one for each of the " + std::to_string(axes.size()) + " axes", ""});
    if (members.empty() && !axes.empty())
      all.push_back({"axes", "there are axes and no members", "members with their values", ""});
    return all;
  }
};

}  // namespace langer
