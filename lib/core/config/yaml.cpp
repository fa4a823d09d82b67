// The parser: yaml-cpp's events, whose marks are exact, become trees; then includes are merged.
#include "core/base/input_file.hpp"
#include "core/base/text.hpp"
#include "core/config/raw_yaml.hpp"
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

// Limits that no sensible file reaches: aliases and includes can multiply a small file (the
// "billion laughs") or nest it without end.
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
    if (expects_key()) return read_key(value, mark);
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
    bool has_key = false;
    bool drop = false;  // the key was refused: its value is read and dropped
    std::unordered_map<std::string, int> lines = {};  // the line of each key of a map
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
  void read_key(const std::string& key, const YAML::Mark& mark) {
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
    int line = 0;
    int column = 0;
    if (!e.mark.is_null()) {
      line = e.mark.line + 1;
      column = e.mark.column + 1;
    }
    const YamlTrouble t = yaml_trouble(text, line, column, e.msg);
    refuse({file, t.line, t.column}, t.found, t.expected, t.hint);
  }
  if (!builder.errors.empty()) throw Failure(Exit::config, builder.errors);
  return std::move(builder.root);
}

// Adds the keys of `over` to `base`. Maps are merged key by key; any other value is replaced, and
// removed by `key: null`.
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

// Each value has a bit set for every layer (file) that it comes from: bit 0 for the outermost file,
// higher bits for included ones.
std::uint64_t layers_in(const Tree& tree) {
  std::uint64_t all = tree.layers;
  for (const Tree& item : tree.list) all |= layers_in(item);
  for (const auto& entry : tree.map) all |= layers_in(entry.value);
  return all;
}

void lower_layers(Tree& tree, int layers) {
  if (layers < 64) {
    tree.layers = tree.layers << layers;
  } else {
    tree.layers = 0;
  }
  for (Tree& item : tree.list) lower_layers(item, layers);
  for (auto& entry : tree.map) lower_layers(entry.value, layers);
}

void overlay(Tree& base, const Tree& over) {
  lower_layers(base, std::bit_width(layers_in(over)));
  merge(base, over);
}

// Files being read, outermost first, for cycles.
struct OpenFiles {
  std::vector<fs::path> files;
  std::size_t n_parts = 0;
};

Tree load(const std::string& path, OpenFiles& open_files);

// The canonical name, or the given one if a folder on the way may not be read.
fs::path own_name(const fs::path& path) {
  std::error_code ec;
  const fs::path canonical = fs::weakly_canonical(path, ec);
  if (ec) return path.lexically_normal();
  return canonical;
}

// A hint for a file that does not exist: its present name if it was renamed, or the most similar
// name in the same folder.
std::string suggested_file(const fs::path& path) {
  std::error_code ec;
  std::vector<std::string> siblings;
  for (const auto& entry :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : fs::path("."), ec))
    if (entry.path().extension() == ".yaml") siblings.push_back(entry.path().filename().string());
  const std::string name = path.filename().string();
  std::string now;
  if (name == "trade.yaml") {
    now = "refinement_study.yaml";
  } else if (name.starts_with("trade_")) {
    now = "refinement" + name.substr(5);
  }
  if (std::ranges::find(siblings, now) == siblings.end()) now = nearest(name, siblings);
  return did_you_mean(now);
}

// Replaces `include` by the content of its files: later files override earlier ones, and the keys
// of the map itself override all of them.
void resolve_includes(Tree& tree, OpenFiles& open_files) {
  for (Tree& item : tree.list) resolve_includes(item, open_files);
  for (auto& e : tree.map)
    if (e.key != "include") resolve_includes(e.value, open_files);
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
             "a path relative to this file", suggested_file(path));
    if (std::find(open_files.files.begin(), open_files.files.end(), own_name(path)) !=
        open_files.files.end())
      refuse(file->place, "include: " + path.string() + " includes itself");
    const Tree included = load(path.string(), open_files);
    if (included.kind != Tree::Kind::map)
      refuse(file->place, fmt::format("include: {} holds {}", path.string(), description(included)),
             "a map");
    overlay(base, included);
  }
  std::erase_if(tree.map, [](const Tree::Entry& e) { return e.key == "include"; });
  overlay(base, tree);
  tree.map = std::move(base.map);
}

Tree load(const std::string& path, OpenFiles& open_files) {
  std::error_code ec;
  if (fs::is_directory(path, ec))
    throw Failure(Exit::input, Error{{path, 0, 0}, "", "this is a folder", "a YAML file", ""});
  // A pipe of the shell, langer-mesh <(...), has a writer at its other end; reading any other pipe
  // may never end.
  const bool of_shell = path == "/dev/stdin" || path.starts_with("/dev/fd/");
  if (!of_shell && fs::exists(path, ec) && !fs::is_regular_file(path, ec))
    throw Failure(Exit::input, Error{{path, 0, 0}, "", unreadable_reason(path), "a YAML file", ""});
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    Error error{{path, 0, 0}, "", "cannot be read", "", ""};
    if (!fs::exists(path, ec)) {
      error.found = "there is no such file";
      error.hint = suggested_file(path);
    }
    throw Failure(Exit::input, error);
  }
  std::string text;  // read in parts: a device has no size, and most files are small
  std::array<char, 1 << 14> part;
  do {
    file.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
  } while (file && text.size() <= largest_file);
  if (text.size() > largest_file)
    refuse({path, 0, 0}, fmt::format("larger than {} bytes", largest_file), "a YAML file");
  open_files.files.push_back(own_name(path));
  Tree tree = parse(text, path, fs::path(path).parent_path().string(), open_files.n_parts);
  resolve_includes(tree, open_files);
  open_files.files.pop_back();
  return tree;
}

}  // namespace

Tree load_yaml(const std::string& path) {
  OpenFiles open_files;
  return load(path, open_files);
}

Tree parse_yaml(const std::string& text, const std::string& shown_name, const std::string& base) {
  OpenFiles open_files;
  Tree tree = parse(text, shown_name, base, open_files.n_parts);
  resolve_includes(tree, open_files);
  return tree;
}

Tree parse_yaml_as_written(const std::string& text, const std::string& shown_name) {
  std::size_t n_parts = 0;
  return parse(text, shown_name, "", n_parts);
}

}  // namespace langer
