#include "mechanics/material/parameters.hpp"

#include <algorithm>
#include <map>

#include "core/config/member.hpp"

namespace langer {

namespace {

using List = std::vector<MaterialParameter>;

template <Listed T>
void collect(T& object, const std::string& path, List& list);

template <class V>
void collect_member(V& value, const Member& m, const std::string& path, List& list) {
  if constexpr (std::is_same_v<V, double>) {
    const auto dot = path.rfind('.');  // npos + 1 is 0: a path of one word
    MaterialParameter parameter{path, path.substr(dot + 1), m.unit, m.range, &value, m.search, ""};
    if (*m.sign_of) parameter.sign_of = path.substr(0, dot + 1) + m.sign_of;
    list.push_back(std::move(parameter));
  } else if constexpr (is_sum<V>) {
    std::map<std::string, int> count;
    const auto key = [](const auto& term) {
      return std::string(std::remove_cvref_t<decltype(term)>::key);
    };
    for (const auto& term : value) ++count[std::visit(key, term)];
    bool once = true;
    for (const auto& [name, n] : count) once = once && n == 1;
    for (std::size_t i = 0; i < value.size(); ++i)
      std::visit(
          [&](auto& term) {
            std::string of_term = path;
            if (!once) of_term += "[" + std::to_string(i) + "]";
            collect(term, of_term + "." + key(term), list);
          },
          value[i]);
  } else if constexpr (is_choice<V>) {
    std::visit(
        [&](auto& term) {
          collect(term, path + "." + std::remove_cvref_t<decltype(term)>::key, list);
        },
        value);
  } else if constexpr (is_optional<V>) {
    if (value) collect_member(*value, m, path, list);
  } else if constexpr (is_vector<V>) {
    for (std::size_t i = 0; i < value.size(); ++i)
      collect_member(value[i], m, path + "[" + std::to_string(i) + "]", list);
  } else if constexpr (Listed<V>) {
    collect(value, path, list);
  }
}

template <Listed T>
void collect(T& object, const std::string& path, List& list) {
  for_each_line(object, [&](const Member& m, auto& value) {
    std::string of_member = path;
    if (!path.empty() && *m.key) of_member += ".";
    collect_member(value, m, of_member + m.key, list);
  });
}

// Two parameters of one name but different units: the deeper one gets the name of its term as a
// prefix (exp_pow_alpha, because alpha is the angle of the family).
void make_names_unique(List& list) {
  const auto depth = [](const MaterialParameter& p) {
    return std::count(p.key.begin(), p.key.end(), '.');
  };
  std::vector<MaterialParameter*> found;
  for (MaterialParameter& p : list)
    for (const MaterialParameter& other : list)
      if (p.name == other.name && p.unit != other.unit && depth(p) > depth(other)) {
        found.push_back(&p);
        break;
      }
  for (MaterialParameter* p : found) {
    const auto last = p->key.rfind('.');
    const auto before = p->key.rfind('.', last - 1) + 1;
    p->name = p->key.substr(before, last - before) + "_" + p->name;
  }
}

}  // namespace

std::vector<MaterialParameter> parameters(Material& material) {
  List list;
  collect(material, "", list);
  make_names_unique(list);
  std::map<std::string, int> count;
  for (MaterialParameter& p : list)
    if (const int n = ++count[p.name]; n > 1) p.name += "_" + std::to_string(n);
  return list;
}

}  // namespace langer
