// The parser: yaml-cpp's events, whose marks are exact, become trees; then includes are merged.
#include "core/base/input_file.hpp"
#include "core/config/tree.hpp"
#include "core/config/yaml_words.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <unordered_map>

namespace langer {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t deepest = 64;
constexpr std::size_t most_parts = 100'000;
constexpr std::size_t largest_file = 4 << 20;  // bytes

[[noreturn]] void refuse(const Place& place, std::string found, std::string expected = "",
                         std::string hint = "") {
  throw Failure(Exit::config,
                Error{place, "", std::move(found), std::move(expected), std::move(hint)});
}

std::size_t depth(const Tree& t) {
  std::size_t d = 0;
  for (const Tree& item : t.list) d = std::max(d, depth(item));
  for (const auto& e : t.map) d = std::max(d, depth(e.value));
  return d + 1;
}

std::size_t parts(const Tree& t) {
  std::size_t n = 1;
  for (const Tree& item : t.list) n += parts(item);
  for (const auto& e : t.map) n += parts(e.value);
  return n;
}

// Builds a tree from the parser's events; every event has an exact mark, which the parser's own
// nodes do not keep.
class Builder : public YAML::EventHandler {
 public:
  Builder(std::string file, std::string base, std::size_t& n_parts)
      : file_(std::move(file)), base_(std::move(base)), n_parts_(n_parts) {}

  Tree root;
  std::vector<Error> errors;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) refuse(place(mark), "found an empty key", "a name before \":\"");
    add(made(Tree::Kind::null, mark), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_tag(tag, mark);
    if (expects_key()) return take_key(value, mark);
    Tree t = made(Tree::Kind::scalar, mark);
    t.scalar = value;
    t.quoted = tag == "!";
    add(std::move(t), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) refuse(place(mark), "found an alias as a key", "a name");
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end())
      refuse(place(mark), "found an alias inside its own anchor",
             "a value that does not contain itself");
    n_parts_ += parts(known->second);
    check_size(mark);
    if (open_.size() + depth(known->second) > deepest) refuse_depth(mark);
    Tree t = known->second;
    t.place = place(mark);
    add(std::move(t), 0);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(Tree::Kind::list, mark, tag, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(Tree::Kind::map, mark, tag, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    Tree tree;
    YAML::anchor_t anchor;
    std::string key;  // of a map: the key whose value comes next
    Place key_place;
    bool has_key = false,
         drop = false;  // drop: the key was refused, its value is read and forgotten
    std::unordered_map<std::string, int> lines = {};  // where each key of a map stands
  };
  std::string file_, base_;
  std::size_t& n_parts_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Tree> anchors_;

  Place place(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }
  bool expects_key() const {
    return !open_.empty() && open_.back().tree.kind == Tree::Kind::map && !open_.back().has_key;
  }
  void check_tag(const std::string& tag, const YAML::Mark& mark) {
    if (tag != "" && tag != "?" && tag != "!")
      errors.push_back({place(mark), "", "found the tag " + tag, "a value without a tag", ""});
  }
  void check_size(const YAML::Mark& mark) {
    if (n_parts_ > most_parts)
      refuse(
          place(mark),
          fmt::format("more than {} parts, aliases and includes counted as often as they are used",
                      most_parts));
  }
  void refuse_depth(const YAML::Mark& mark) {
    refuse(place(mark), fmt::format("nested more than {} levels deep", deepest));
  }

  Tree made(Tree::Kind kind, const YAML::Mark& mark) {
    ++n_parts_;
    check_size(mark);
    Tree t;
    t.kind = kind;
    t.place = place(mark);
    t.base = base_;
    return t;
  }
  void take_key(const std::string& key, const YAML::Mark& mark) {
    Open& map = open_.back();
    map.key = key;
    map.key_place = place(mark);
    map.has_key = true;
    map.drop = false;
    if (const auto [first, is_new] = map.lines.emplace(key, map.key_place.line); !is_new) {
      errors.push_back(
          {map.key_place, "",
           fmt::format("the key \"{}\" was already given at line {}", key, first->second),
           "each key once", ""});
      map.drop = true;
    } else if (key == "<<") {
      errors.push_back({map.key_place, "", "found a merge key \"<<\"", "\"include: file\"",
                        "keys next to `include` override the included ones"});
      map.drop = true;
    }
  }
  void begin(Tree::Kind kind, const YAML::Mark& mark, const std::string& tag,
             YAML::anchor_t anchor) {
    check_tag(tag, mark);
    if (expects_key())
      refuse(place(mark),
             kind == Tree::Kind::list ? "found a list as a key" : "found a map as a key", "a name");
    if (open_.size() + 1 > deepest) refuse_depth(mark);
    open_.push_back({made(kind, mark), anchor, "", {}, false, false});
  }
  void end() {
    Open done = std::move(open_.back());
    open_.pop_back();
    add(std::move(done.tree), done.anchor);
  }
  void add(Tree t, YAML::anchor_t anchor) {
    if (anchor) anchors_[anchor] = t;
    if (open_.empty()) {
      root = std::move(t);
      return;
    }
    Open& parent = open_.back();
    if (parent.tree.kind == Tree::Kind::list) {
      parent.tree.list.push_back(std::move(t));
      return;
    }
    t.place = parent.key_place;
    parent.has_key = false;
    if (!parent.drop) parent.tree.map.push_back({parent.key, std::move(t)});
  }
};

Tree parse(const std::string& text, const std::string& file, const std::string& base,
           std::size_t& n_parts) {
  if (text.find('\0') != std::string::npos)
    refuse({file, 0, 0}, "this is not a text file", "a YAML file");
  Builder builder(file, base, n_parts);
  std::istringstream stream(text);
  try {
    YAML::Parser parser(stream);
    builder.root.place = {file, 1, 1};
    builder.root.base = base;
    parser.HandleNextDocument(builder);
    const Tree first = builder.root;
    if (parser.HandleNextDocument(builder))
      refuse(builder.root.place, "found a second document", "one YAML document in a file");
    builder.root = first;
  } catch (const YAML::Exception& e) {
    const YamlTrouble t = yaml_trouble(text, e.mark.is_null() ? 0 : e.mark.line + 1,
                                       e.mark.is_null() ? 0 : e.mark.column + 1, e.msg);
    refuse({file, t.line, t.column}, t.found, t.expected, t.hint);
  }
  if (!builder.errors.empty()) throw Failure(Exit::config, builder.errors);
  return std::move(builder.root);
}

void merge(Tree& base, const Tree& over) {
  std::unordered_map<std::string_view, std::size_t> index;  // a map may have 100 000 keys
  base.map.reserve(base.map.size() + over.map.size());      // so that keys stay where they are
  std::vector<std::size_t> taken;                           // away by `key: null`
  for (std::size_t i = 0; i < base.map.size(); ++i) index.emplace(base.map[i].key, i);
  for (const auto& [key, value] : over.map) {
    const auto known = index.find(key);
    Tree::Entry* const same = known == index.end() ? nullptr : &base.map[known->second];
    if (!same)
      base.map.push_back({key, value});
    else if (value.kind == Tree::Kind::null)
      taken.push_back(known->second);
    else if (same->value.kind == Tree::Kind::map && value.kind == Tree::Kind::map) {
      merge(same->value, value);
      same->value.place = value.place;
      same->value.layers |= value.layers;
    } else {
      const std::uint64_t layers = same->value.layers;
      same->value = value;
      same->value.layers |= layers;
    }
  }
  std::sort(taken.rbegin(), taken.rend());
  for (const std::size_t i : taken)
    base.map.erase(base.map.begin() + static_cast<std::ptrdiff_t>(i));
}

std::uint64_t layers_in(const Tree& tree) {
  std::uint64_t all = tree.layers;
  for (const Tree& item : tree.list) all |= layers_in(item);
  for (const auto& entry : tree.map) all |= layers_in(entry.value);
  return all;
}

void put_under(Tree& tree, int layers) {
  if (layers < 64) {
    tree.layers = tree.layers << layers;
  } else {
    tree.layers = 0;
  }
  for (Tree& item : tree.list) put_under(item, layers);
  for (auto& entry : tree.map) put_under(entry.value, layers);
}

void lay(Tree& base, const Tree& over) {
  put_under(base, std::bit_width(layers_in(over)));
  merge(base, over);
}

// Files being read, outermost first, for cycles.
struct Reading {
  std::vector<fs::path> files;
  std::size_t n_parts = 0;
};

Tree load(const std::string& path, Reading& reading);

// below a folder that may not be looked into, the name as it is given
fs::path own_name(const fs::path& path) {
  std::error_code ec;
  const fs::path canonical = fs::weakly_canonical(path, ec);
  if (ec) return path.lexically_normal();
  return canonical;
}

// What a file that is not there may have been meant for: its present name, or the nearest one
// beside it.
std::string meant_for(const fs::path& path) {
  std::error_code ec;
  std::vector<std::string> beside;
  for (const auto& entry :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : fs::path("."), ec))
    if (entry.path().extension() == ".yaml") beside.push_back(entry.path().filename().string());
  const std::string name = path.filename().string();
  std::string now;
  if (name == "trade.yaml") {
    now = "refinement_study.yaml";
  } else if (name.starts_with("trade_")) {
    now = "refinement" + name.substr(5);
  } else {
    now = "";
  }
  if (std::find(beside.begin(), beside.end(), now) == beside.end()) now = nearest(name, beside);
  if (now.empty()) return "";
  return fmt::format("did you mean \"{}\"?", now);
}

void resolve_includes(Tree& tree, Reading& reading) {
  for (Tree& item : tree.list) resolve_includes(item, reading);
  for (auto& e : tree.map)
    if (e.key != "include") resolve_includes(e.value, reading);
  const Tree* include = tree.find("include");
  if (!include) return;
  std::vector<const Tree*> files;
  if (include->kind == Tree::Kind::list)
    for (const Tree& item : include->list) files.push_back(&item);
  else
    files.push_back(include);
  Tree base;
  base.kind = Tree::Kind::map;
  base.place = tree.place;
  for (const Tree* file : files) {
    if (file->kind != Tree::Kind::scalar || file->scalar.empty())
      refuse(file->place, "include: found " + description(*file), "the path of a YAML file");
    const fs::path path = (fs::path(file->base) / file->scalar).lexically_normal();
    std::error_code ec;
    if (!fs::is_regular_file(path, ec))
      refuse(file->place, "include: there is no file " + path.string(),
             "a path relative to this file", meant_for(path));
    if (std::find(reading.files.begin(), reading.files.end(), own_name(path)) !=
        reading.files.end())
      refuse(file->place, "include: " + path.string() + " includes itself");
    const Tree included = load(path.string(), reading);
    if (included.kind != Tree::Kind::map)
      refuse(file->place, fmt::format("include: {} holds {}", path.string(), description(included)),
             "a map");
    lay(base, included);
  }
  std::erase_if(tree.map, [](const Tree::Entry& e) { return e.key == "include"; });
  lay(base, tree);
  tree.map = std::move(base.map);
}

Tree load(const std::string& path, Reading& reading) {
  std::error_code ec;
  if (fs::is_directory(path, ec))
    throw Failure(Exit::input, Error{{path, 0, 0}, "", "this is a folder", "a YAML file", ""});
  // A pipe of the shell, langer-mesh <(...), has somebody at its other end; any other may wait for
  // ever.
  const bool of_shell = path == "/dev/stdin" || path.starts_with("/dev/fd/");
  if (!of_shell && fs::exists(path, ec) && !fs::is_regular_file(path, ec))
    throw Failure(Exit::input, Error{{path, 0, 0}, "", unreadable_reason(path), "a YAML file", ""});
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Failure(Exit::input,
                  fs::exists(path, ec)
                      ? Error{{path, 0, 0}, "", "cannot be read", "", ""}
                      : Error{{path, 0, 0}, "", "there is no such file", "", meant_for(path)});
  std::string text;  // by parts: a device has no size, and most files are small
  std::array<char, 1 << 14> part;
  do {
    file.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
  } while (file && text.size() <= largest_file);
  if (text.size() > largest_file)
    refuse({path, 0, 0}, fmt::format("larger than {} bytes", largest_file), "a YAML file");
  reading.files.push_back(own_name(path));
  Tree tree = parse(text, path, fs::path(path).parent_path().string(), reading.n_parts);
  resolve_includes(tree, reading);
  reading.files.pop_back();
  return tree;
}

}  // namespace

Tree load_yaml(const std::string& path) {
  Reading reading;
  return load(path, reading);
}

Tree parse_yaml(const std::string& text, const std::string& shown_name, const std::string& base) {
  Reading reading;
  Tree tree = parse(text, shown_name, base, reading.n_parts);
  resolve_includes(tree, reading);
  return tree;
}

}  // namespace langer
