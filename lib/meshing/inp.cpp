// Abaqus and CalculiX input: the cards that describe a mesh. Keywords and set names of other cards
// are skipped, those that make nodes or elements by rule are refused.
#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "core/base/split.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/reference.hpp"
#include "meshing/exchange.hpp"
#include "meshing/inp_cells.hpp"

namespace langer {

namespace {

std::string trimmed(const std::string& s) {
  const std::size_t from = s.find_first_not_of(" \t\r\""), to = s.find_last_not_of(" \t\r\"");
  return from == std::string::npos ? "" : s.substr(from, to - from + 1);
}
std::string upper(std::string s) {
  for (char& c : s) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return s;
}
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (const std::string& cell : split(line, ',')) cells.push_back(trimmed(cell));
  return cells;
}

struct Card {
  std::string word;  // upper case, without the star
  std::map<std::string, std::string> parameters;
  std::string value(const std::string& key) const {
    const auto found = parameters.find(key);
    return found == parameters.end() ? "" : found->second;
  }
};

class Reader {
 public:
  Reader(const std::string& text, const std::string& name, std::vector<std::string>& notes)
      : in_(text), name_(name), notes_(notes) {}

  Mesh read() {
    for (std::string line; next(line);) {
      if (line[0] == '*')
        begin(line);
      else
        data(line);
    }
    end_element();
    if (cells_.empty())
      refuse(0, "no hexahedra or tetrahedra", "*ELEMENT, TYPE=, " + known_inp_cells());
    return mesh();
  }

 private:
  std::istringstream in_;
  std::string name_;
  std::vector<std::string>& notes_;
  int line_ = 0;
  Card card_;
  std::map<long long, Vec3> nodes_;
  InpCell kind_;      // of all cells
  std::string type_;  // as the file calls it first
  std::map<long long, std::pair<std::vector<long long>, int>>
      cells_;                       // nodes in their order, with the line
  std::vector<long long> element_;  // as far as it is read
  int element_line_ = 0;
  struct Range {
    long long first, last, step;
    auto operator<=>(const Range&) const = default;
  };
  struct Named {  // as the file writes it: sets are looked up without regard to case
    std::string name;
    std::vector<Range> members;
    void add(long long id) { members.push_back({id, id, 1}); }
  };
  std::map<std::string, Named> node_sets_, element_sets_;
  struct Side {
    std::string what, side;
    int line;
  };
  std::map<std::string, std::pair<std::string, std::vector<Side>>> surfaces_;
  std::vector<std::string> bodies_, element_bodies_;  // keys of element sets
  std::set<std::string> left_out_;
  int instances_ = 0, parts_ = 0;

  [[noreturn]] void refuse(int line, const std::string& found, const std::string& expected = "",
                           const std::string& hint = "") const {
    throw Failure(Exit::input, Error{{name_, line, line ? 1 : 0}, "", found, expected, hint});
  }

  bool next(std::string& line) {
    while (std::getline(in_, line)) {
      ++line_;
      line = trimmed(line);
      if (!line.empty() && !line.starts_with("**")) return true;
    }
    return false;
  }

  long long whole(const std::string& text) const {
    long long n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size())
      refuse(line_, "found \"" + text + "\"", "a whole number");
    return n;
  }
  double real(std::string text) const {
    if (text.empty()) return 0;  // as in Abaqus
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
    const char* begin = text.data() + (text[0] == '+');
    double x = 0;
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(x))
      refuse(line_, "found \"" + text + "\"", "a number");
    return x;
  }
  static bool is_number(const std::string& text) {
    return !text.empty() &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
  }

  void begin(std::string line) {
    end_element();
    const int first = line_;
    while (line.ends_with(',')) {
      std::string more;
      if (!next(more)) break;
      line += more;
    }
    const std::vector<std::string> cells = cells_of(line.substr(1));
    card_ = {};
    card_.word = cells.empty() ? "" : upper(cells[0]);
    for (std::size_t i = 1; i < cells.size(); ++i) {
      const std::size_t equals = cells[i].find('=');
      card_.parameters[upper(trimmed(cells[i].substr(0, equals)))] =
          equals == std::string::npos ? "" : trimmed(cells[i].substr(equals + 1));
    }
    static const std::set<std::string> made_by_rule{"NGEN",   "NFILL",   "NCOPY",  "ELGEN",
                                                    "ELCOPY", "INCLUDE", "SYSTEM", "NMAP"};
    if (made_by_rule.count(card_.word))
      refuse(first, "found *" + card_.word, "all nodes and elements written out in this file");
    if (card_.word == "PART" && ++parts_ > 1) refuse(first, "found a second *PART", "one");
    if (card_.word == "INSTANCE" && ++instances_ > 1)
      refuse(first, "found a second *INSTANCE", "one");
    if (card_.word == "ELEMENT") {
      begin_elements(first);
    } else if (card_.word == "NSET" || card_.word == "ELSET") {
      if (card_.value(card_.word).empty())
        refuse(first, "*" + card_.word + " without a name", card_.word + "=name");
      named(card_.word == "NSET" ? node_sets_ : element_sets_, card_.value(card_.word));
    } else if (card_.word == "SURFACE") {
      if (card_.value("NAME").empty()) refuse(first, "*SURFACE without a name", "NAME=name");
      surfaces_[upper(card_.value("NAME"))].first = card_.value("NAME");
    } else if (card_.word == "SOLID SECTION") {
      const std::string key = upper(card_.value("ELSET"));
      if (std::find(bodies_.begin(), bodies_.end(), key) == bodies_.end()) bodies_.push_back(key);
    } else if (card_.word != "NODE" && card_.word != "INSTANCE") {
      static const std::set<std::string> nothing{
          "HEADING", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "END INSTANCE", "PREPRINT"};
      if (!nothing.count(card_.word)) left_out_.insert("*" + card_.word);
    }
  }

  void begin_elements(int line) {
    const std::string type = upper(card_.value("TYPE"));
    const auto kind = inp_cell(type);
    if (!kind) {
      if (type.starts_with("C3D")) refuse(line, "found elements " + type, known_inp_cells());
      left_out_.insert("elements " + type);
      card_.word = "";
      return;
    }
    if (kind_.theirs && kind->theirs != kind_.theirs)
      refuse(line, fmt::format("found elements {} beside {}", type, type_), "cells of one kind");
    kind_ = *kind;
    if (type_.empty()) type_ = type;
    if (const std::string set = card_.value("ELSET"); !set.empty())
      if (const std::string key = named(element_sets_, set);
          std::find(element_bodies_.begin(), element_bodies_.end(), key) == element_bodies_.end())
        element_bodies_.push_back(key);
  }

  static std::string named(std::map<std::string, Named>& sets, const std::string& name) {
    const std::string key = upper(name);
    sets.try_emplace(key, Named{name, {}});
    return key;
  }

  void data(const std::string& line) {
    const std::vector<std::string> cells = cells_of(line);
    if (card_.word == "NODE") {
      if (cells.size() < 2) refuse(line_, "found \"" + line + "\"", "number, x, y, z");
      const long long id = whole(cells[0]);
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < 3 && k + 1 < static_cast<int>(cells.size()); ++k)
        x[k] = real(cells[static_cast<std::size_t>(k) + 1]);
      if (!nodes_.try_emplace(id, x).second)
        refuse(line_, fmt::format("node {} is there twice", id));
      if (const std::string set = card_.value("NSET"); !set.empty())
        node_sets_[named(node_sets_, set)].add(id);
    } else if (card_.word == "ELEMENT") {
      if (element_.empty()) element_line_ = line_;
      for (const std::string& cell : cells)
        if (!cell.empty()) element_.push_back(whole(cell));
      if (element_.size() > kind_.theirs->order.size()) end_element();
    } else if (card_.word == "NSET")
      members(cells, node_sets_, card_.value("NSET"));
    else if (card_.word == "ELSET")
      members(cells, element_sets_, card_.value("ELSET"));
    else if (card_.word == "SURFACE")
      surface(cells);
    else if (card_.word == "INSTANCE")
      refuse(line_, "found an *INSTANCE that is moved or turned",
             "one that lies where its part does");
  }

  void end_element() {
    if (element_.empty()) return;
    const std::size_t n = kind_.theirs->order.size();
    if (element_.size() != n + 1)
      refuse(element_line_, fmt::format("an element of {} nodes", element_.size() - 1),
             fmt::format("{} nodes, on one line or on lines ending with a comma", n));
    std::vector<long long> nodes(element_.begin() + 1, element_.end());
    if (!cells_.try_emplace(element_[0], std::pair(std::move(nodes), element_line_)).second)
      refuse(element_line_, fmt::format("element {} is there twice", element_[0]));
    if (const std::string set = card_.value("ELSET"); !set.empty())
      element_sets_[named(element_sets_, set)].add(element_[0]);
    element_.clear();
  }

  void members(const std::vector<std::string>& cells, std::map<std::string, Named>& sets,
               const std::string& name) {
    Named& set = sets[upper(name)];
    if (card_.parameters.count("GENERATE")) {
      if (cells.size() < 2) refuse(line_, "one number", "first, last, step");
      const long long first = whole(cells[0]), last = whole(cells[1]),
                      step = cells.size() > 2 && !cells[2].empty() ? whole(cells[2]) : 1;
      if (step <= 0 || first < 0 || last < first)
        refuse(line_, "a range that does not ascend", "first, last, step");
      set.members.push_back({first, last, step});
      return;
    }
    for (const std::string& cell : cells) {
      if (cell.empty()) continue;
      if (is_number(cell)) {
        set.add(whole(cell));
        continue;
      }
      const auto other = sets.find(upper(cell));
      if (other == sets.end())
        refuse(line_, "there is no set \"" + cell + "\" above",
               "numbers, or a set that stands above");
      const std::vector<Range> copy = other->second.members;
      set.members.insert(set.members.end(), copy.begin(), copy.end());
      std::sort(set.members.begin(), set.members.end());
      set.members.erase(std::unique(set.members.begin(), set.members.end()), set.members.end());
    }
  }

  // those of a set that are there, as our numbers
  static std::vector<int> there(const Named& set, const std::map<long long, int>& numbers) {
    std::set<int> found;
    for (const Range& range : set.members)
      if (range.first == range.last) {
        if (const auto one = numbers.find(range.first); one != numbers.end())
          found.insert(one->second);
      } else
        for (auto one = numbers.lower_bound(range.first);
             one != numbers.end() && one->first <= range.last; ++one)
          if ((one->first - range.first) % range.step == 0) found.insert(one->second);
    return {found.begin(), found.end()};
  }

  void surface(const std::vector<std::string>& cells) {
    const std::string key = upper(card_.value("NAME")), type = upper(card_.value("TYPE"));
    if (type == "NODE") {
      node_sets_.try_emplace(key, Named{card_.value("NAME"), {}});
      members({cells.at(0)}, node_sets_, card_.value("NAME"));
      return;
    }
    surfaces_[key].second.push_back({cells[0], cells.size() > 1 ? upper(cells[1]) : "", line_});
  }

  using Numbers =
      std::map<long long, int>;  // the file's number of a node or cell: ours, without gaps

  Mesh made_of_cells(Numbers& cell_at, Numbers& node_at) {
    std::vector<Vec3> X;
    std::vector<int> connectivity;  // in our order
    const std::vector<int>& order = kind_.theirs->order;
    for (const auto& [id, cell] : cells_)
      for (long long n : cell.first) node_at[n] = -1;
    for (const auto& [id, x] : nodes_)
      if (const auto node = node_at.find(id); node != node_at.end())
        node->second = static_cast<int>(X.size()), X.push_back(x);
    for (const auto& [id, cell] : cells_) {
      cell_at[id] = static_cast<int>(connectivity.size() / order.size());
      connectivity.resize(connectivity.size() + order.size());
      for (std::size_t a = 0; a < order.size(); ++a) {
        const long long n = cell.first[a];
        if (node_at[n] < 0)
          refuse(cell.second, fmt::format("element {} has the node {}, which is not there", id, n));
        connectivity[connectivity.size() - order.size() + static_cast<std::size_t>(order[a])] =
            node_at[n];
      }
    }
    if (static_cast<int>(order.size()) == kind_.cell->n_corners)
      return raised(X, connectivity, kind_.cell->type);
    if (static_cast<int>(order.size()) < kind_.cell->n_nodes)
      return raised_with_edges(X, connectivity, kind_.cell->type);
    Mesh mesh;
    mesh.type = kind_.cell->type, mesh.X = X, mesh.connectivity = connectivity;
    return mesh;
  }

  void add_bodies(Mesh& mesh, const Numbers& cell_at) {
    mesh.body.assign(static_cast<std::size_t>(mesh.n_cells()), -1);
    for (const std::string& key : bodies_.empty() ? element_bodies_ : bodies_) {
      const auto set = element_sets_.find(key);
      if (set == element_sets_.end())
        refuse(0, "*SOLID SECTION of the element set \"" + key + "\", which is not there");
      const int body = static_cast<int>(mesh.bodies.size());
      mesh.bodies.push_back(set->second.name);
      for (int cell : there(set->second, cell_at)) {
        if (mesh.body[cell] >= 0)
          refuse(0,
                 fmt::format("the {}. element belongs to \"{}\" and to \"{}\"", cell + 1,
                             mesh.bodies[mesh.body[cell]], mesh.bodies[body]),
                 "one body for each element");
        mesh.body[cell] = body;
      }
    }
    if (std::count(mesh.body.begin(), mesh.body.end(), -1) > 0) {
      for (int& body : mesh.body)
        if (body < 0) body = static_cast<int>(mesh.bodies.size());
      mesh.bodies.push_back("");
    }
  }

  std::vector<int> cells_of_side(const Side& side, const Numbers& cell_at) {
    if (is_number(side.what)) {
      const auto cell = cell_at.find(side.what.size() < 18 ? std::stoll(side.what) : -1);
      if (cell == cell_at.end()) refuse(side.line, "there is no element " + side.what);
      return {cell->second};
    }
    const auto set = element_sets_.find(upper(side.what));
    if (set == element_sets_.end())
      refuse(side.line, "there is no element set \"" + side.what + "\"");
    return there(set->second, cell_at);
  }

  int facet_of(const Side& side) const {
    const std::vector<int>& facets = kind_.cell->names.abaqus.sides;
    for (std::size_t s = 0; s < facets.size(); ++s)
      if (side.side == fmt::format("S{}", s + 1)) return facets[s];
    refuse(side.line, "found the side \"" + side.side + "\"",
           fmt::format("S1 to S{}", facets.size()));
  }

  void add_sets(Mesh& mesh, const Numbers& cell_at, const Numbers& node_at) {
    for (const auto& [key, surface] : surfaces_) {
      const auto& [name, sides] = surface;
      std::vector<Facet> facets;
      for (const Side& side : sides)
        for (int cell : cells_of_side(side, cell_at)) facets.push_back({cell, facet_of(side)});
      if (!facets.empty()) name_facets(mesh, name, facets);
    }
    for (const auto& [key, set] : node_sets_) {
      const std::vector<int> nodes = there(set, node_at);
      if (!nodes.empty()) mesh.node_sets[set.name] = nodes;
    }
    const auto n_given = static_cast<int>(node_at.size());
    if (n_given < mesh.n_nodes()) add_new_middles(mesh, n_given);
  }

  Mesh mesh() {
    Numbers cell_at, node_at;
    Mesh mesh = made_of_cells(cell_at, node_at);
    add_bodies(mesh, cell_at);
    add_sets(mesh, cell_at, node_at);
    std::vector<std::string> others;
    for (const auto& [key, set] : element_sets_)
      if (std::find(mesh.bodies.begin(), mesh.bodies.end(), set.name) == mesh.bodies.end())
        others.push_back(set.name);
    if (!others.empty())
      notes_.push_back(
          fmt::format("left out, as they are no bodies: element sets {}", fmt::join(others, ", ")));
    if (!left_out_.empty())
      notes_.push_back(
          fmt::format("left out, as they are no mesh: {}", fmt::join(left_out_, ", ")));
    return mesh;
  }
};

}  // namespace

Mesh parse_inp(const std::string& text, const std::string& shown_name,
               std::vector<std::string>& notes) {
  return Reader(text, shown_name, notes).read();
}

Mesh read_inp(const std::string& path, std::vector<std::string>& notes) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw Failure(Exit::input, Error{{path}, "", "cannot be read", "", ""});
  return parse_inp(text.str(), path, notes);
}

}  // namespace langer
