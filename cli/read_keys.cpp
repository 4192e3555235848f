// The only file that knows toml++.
#define TOML_ENABLE_FORMATTERS 0
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "cli/key_table.hpp"

namespace arris {
namespace {

std::string line_of(const std::string& file, const toml::source_region& source) {
  return source.begin ? fmt::format("{}:{}", file, source.begin.line) : file;
}

/// What the file holds instead, for a message.
std::string found_text(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "the text " + quote(node.ref<std::string>());
    case toml::node_type::integer:
      return fmt::format("the whole number {}", node.ref<std::int64_t>());
    case toml::node_type::floating_point:
      return fmt::format("the number {}", node.ref<double>());
    case toml::node_type::boolean:
      return node.ref<bool>() ? "true" : "false";
    case toml::node_type::array:
      return fmt::format("a list of {}", node.as_array()->size());
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

bool put_value(const toml::node& node, double& value) {
  if (!node.is_number()) return false;
  value = *node.value<double>();
  return true;
}

bool put_value(const toml::node& node, int& value) {
  const auto number = node.value_exact<std::int64_t>();
  if (!number || *number < std::numeric_limits<int>::min() || *number > std::numeric_limits<int>::max())
    return false;
  value = static_cast<int>(*number);
  return true;
}

bool put_value(const toml::node& node, std::string& value) {
  if (!node.is_string()) return false;
  value = node.ref<std::string>();
  return true;
}

template <class T>
bool put_list(const toml::node& node, std::vector<T>& values) {
  if (!node.is_array()) return false;
  std::vector<T> read;
  for (const toml::node& element : *node.as_array()) {
    T value{};
    if (!put_value(element, value)) return false;
    read.push_back(value);
  }
  values = std::move(read);
  return true;
}

/// Stores the node's value in the slot; false when it is of another type.
bool put(const toml::node& node, const Slot& slot, const std::filesystem::path& folder) {
  if (auto* const* text = std::get_if<std::string*>(&slot)) return put_value(node, **text);
  if (auto* const* path = std::get_if<std::filesystem::path*>(&slot)) {
    if (!node.is_string()) return false;
    const std::string& name = node.ref<std::string>();
    **path = name.empty() ? std::filesystem::path() : (folder / name).lexically_normal();
    return true;
  }
  if (auto* const* flag = std::get_if<bool*>(&slot)) {
    if (!node.is_boolean()) return false;
    **flag = node.ref<bool>();
    return true;
  }
  if (auto* const* optional = std::get_if<std::optional<double>*>(&slot)) {
    double value = 0.0;
    if (!put_value(node, value)) return false;
    **optional = value;
    return true;
  }
  if (auto* const* number = std::get_if<int*>(&slot)) return put_value(node, **number);
  if (auto* const* number = std::get_if<double*>(&slot)) return put_value(node, **number);
  if (auto* const* list = std::get_if<std::vector<int>*>(&slot)) return put_list(node, **list);
  if (auto* const* list = std::get_if<std::vector<std::string>*>(&slot)) return put_list(node, **list);
  return put_list(node, **std::get_if<std::vector<double>*>(&slot));
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, const std::vector<Key>& keys,
         const std::set<std::string>& reserved)
      : file_(file.string()), folder_(file.parent_path()), keys_(keys), reserved_(reserved) {
    for (const Key& key : keys) {
      names_.push_back(key.name);
      for (auto dot = key.name.find('.'); dot != std::string::npos; dot = key.name.find('.', dot + 1))
        tables_.push_back(key.name.substr(0, dot));
    }
    std::sort(tables_.begin(), tables_.end());
    tables_.erase(std::unique(tables_.begin(), tables_.end()), tables_.end());
  }

  void walk(const toml::table& table, const std::string& prefix) {
    std::vector<std::pair<std::string, const toml::node*>> entries;
    for (const auto& [name, node] : table) entries.emplace_back(prefix + std::string(name.str()), &node);
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      return std::pair(a.second->source().begin.line, a.second->source().begin.column) <
             std::pair(b.second->source().begin.line, b.second->source().begin.column);
    });
    for (const auto& [name, node] : entries) visit(name, *node);
  }

  KeysRead finish() {
    for (const Key& key : keys_) {
      if (!key.required || result_.given.contains(key.name)) continue;
      const auto dot = key.name.rfind('.');
      const std::string where =
          dot == std::string::npos ? file_ : file_ + ", [" + key.name.substr(0, dot) + "]";
      result_.problems.push_back(
          {key.name + " is missing", where, "no such key", type_text(key), "add it: " + key.about});
    }
    return std::move(result_);
  }

 private:
  void visit(const std::string& name, const toml::node& node) {
    if (node.is_table() && reserved_.contains(name)) return;
    const bool is_table_name = std::binary_search(tables_.begin(), tables_.end(), name);
    const auto key = std::find_if(keys_.begin(), keys_.end(), [&](const Key& k) { return k.name == name; });
    if (key != keys_.end())
      set(*key, node);
    else if (!is_table_name)
      unknown(name, node);
    else if (node.is_table()) {
      result_.tables.insert(name);
      walk(*node.as_table(), name + ".");
    } else
      result_.problems.push_back({"[" + name + "] is a table, not a value", line_of(file_, node.source()),
                                  found_text(node), "keys below [" + name + "]",
                                  "write a line [" + name + "] and its keys below it"});
  }

  void set(const Key& key, const toml::node& node) {
    result_.given.insert(key.name);
    std::visit(
        [&](auto* slot) {
          const auto before = *slot;
          std::optional<ErrorText> problem;
          if (!put(node, key.slot, folder_))
            problem = ErrorText{key.name + " has the wrong type",
                                {},
                                found_text(node),
                                type_text(key),
                                "correct it: " + key.about};
          else
            problem = check_value(key);
          if (!problem) return;
          *slot = before;
          problem->where = line_of(file_, node.source());
          result_.problems.push_back(*problem);
        },
        key.slot);
  }

  void unknown(const std::string& name, const toml::node& node) {
    const bool table = node.is_table();
    const auto dot = name.rfind('.');
    ErrorText problem{"unknown " + std::string(table ? "table [" + name + "]" : "key " + name),
                      line_of(file_, node.source()), table ? "a table of that name" : found_text(node),
                      table ? "a table that arris knows" : "a key that arris knows",
                      "arris recipe print lists every key"};
    const std::string near = nearest(name, table);
    if (!near.empty())
      problem.next = "did you mean " + near + "?";
    else if (dot == std::string::npos && !table)
      problem.next = "is a [table] line missing above it? arris recipe print lists every key";
    result_.problems.push_back(problem);
  }

  /// The nearest name in the same table; else the same last word in another table.
  [[nodiscard]] std::string nearest(const std::string& name, bool table) const {
    const std::string prefix = name.substr(0, name.rfind('.') + 1);  // npos + 1 is 0
    std::vector<std::string> siblings;
    for (const auto* known : {table ? &tables_ : &names_, table ? &names_ : &tables_})
      for (const std::string& candidate : *known)
        if (candidate.starts_with(prefix) && candidate.find('.', prefix.size()) == std::string::npos)
          siblings.push_back(candidate.substr(prefix.size()));
    const std::string leaf = name.substr(prefix.size());
    if (const std::string near = nearest_name(leaf, siblings); !near.empty()) return prefix + near;
    for (const std::string& known : names_)
      if (known.ends_with("." + leaf)) return known;
    return {};
  }

  std::string file_;
  std::filesystem::path folder_;
  const std::vector<Key>& keys_;
  const std::set<std::string>& reserved_;
  std::vector<std::string> names_, tables_;
  KeysRead result_;
};

}  // namespace

KeysRead read_keys(const std::filesystem::path& file, const std::string& text, const std::vector<Key>& keys,
                   const std::set<std::string>& reserved) {
  Reader reader(file, keys, reserved);
  try {
    reader.walk(toml::parse(text, file.string()), "");
    return reader.finish();
  } catch (const toml::parse_error& error) {
    KeysRead failed;
    failed.problems.push_back({"the file is no valid TOML", line_of(file.string(), error.source()),
                               std::string(error.description()), "lines key = value, below lines [table]",
                               "correct that line"});
    return failed;
  }
}

}  // namespace arris
