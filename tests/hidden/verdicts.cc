#include "tests/hidden/verdicts.h"

#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/hidden/sha256.h"

namespace strut::hidden {
namespace {

namespace fs = std::filesystem;
using test::JsonTree;

std::string read_bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error(path.string() + ": cannot be read");
  return text.str();
}

/// {"value": v, "ci95": [low, high]}
std::map<std::string, Estimate> get_estimates(const JsonTree& tree, const std::string& key) {
  std::map<std::string, Estimate> estimates;
  const auto found = tree.get_child_optional(key);
  if (!found) return estimates;
  for (const auto& [name, child] : *found) {
    Estimate e;
    e.value = child.get<double>("value", 0.0);
    std::vector<double> ends;
    if (const auto interval = child.get_child_optional("ci95")) {
      for (const auto& end : *interval) ends.push_back(end.second.get_value<double>(0.0));
    }
    if (ends.size() == 2) {
      e.low = ends[0];
      e.high = ends[1];
    }
    estimates[name] = e;
  }
  return estimates;
}

/// Nothing for null and for missing keys.
std::optional<double> get_number(const JsonTree& tree, const std::string& key) {
  const auto found = tree.get_optional<double>(key);
  return found ? std::optional<double>(*found) : std::nullopt;
}

std::vector<Claim> get_claims(const JsonTree& tree, const std::string& key) {
  std::vector<Claim> claims;
  const auto found = tree.get_child_optional(key);
  if (!found) return claims;
  for (const auto& entry : *found) {
    const JsonTree& child = entry.second;
    claims.push_back({child.get<std::string>("effect", ""), child.get<std::string>("place", ""),
                      child.get<double>("probability", 0.0), get_estimates(child, "parameters")});
  }
  return claims;
}

std::vector<CauseName> get_names(const JsonTree& tree, const std::string& key) {
  std::vector<CauseName> names;
  for (const auto& entry : tree.get_child(key)) {
    names.push_back(
        {entry.second.get<std::string>("effect"), entry.second.get<std::string>("place")});
  }
  return names;
}

TrueTrial get_truth(const fs::path& path, const JsonTree& tree) {
  TrueTrial trial;
  trial.name = path.stem().string();
  trial.kit = tree.get<std::string>("kit", "");
  trial.category = tree.get<std::string>("category", "");
  trial.grade = tree.get<std::string>("grade").front();
  trial.beyond_one = tree.get<double>("beyond_one");
  trial.beyond_two = tree.get<double>("beyond_two");
  trial.roughness = tree.get<double>("roughness", 0.0);
  if (trial.category.empty()) throw std::runtime_error(path.string() + ": category: is missing");
  for (const auto& entry : tree.get_child("faults")) {
    const JsonTree& f = entry.second;
    trial.faults.push_back({f.get<std::string>("fault"), f.get<std::string>("effect"),
                            f.get<std::string>("place"), f.get<std::string>("parameter"),
                            f.get<double>("magnitude"), f.get<std::string>("grade").front(),
                            f.get<std::string>("where"), get_names(f, "twins")});
  }
  for (const auto& [name, value] : tree.get_child("parameters")) {
    trial.parameters[name] = value.get_value<double>();
  }
  for (const auto& [name, value] : tree.get_child("bounds")) {
    trial.bounds[name] = value.get_value<double>();
  }
  return trial;
}

}  // namespace

JsonTree read_json(const fs::path& path) {
  try {
    return test::parse_json(read_bytes(path));
  } catch (const boost::property_tree::ptree_error& e) {
    throw std::runtime_error(path.string() + ": " + e.what());
  }
}

TrueTrial read_truth(const fs::path& path) {
  const JsonTree tree = read_json(path);
  try {
    return get_truth(path, tree);
  } catch (const boost::property_tree::ptree_error& e) {
    throw std::runtime_error(path.string() + ": " + e.what());
  }
}

Verdict read_verdict(const fs::path& path) {
  const JsonTree tree = read_json(path);
  Verdict v;
  v.verdict = tree.get<std::string>("verdict", "");
  v.causes = get_claims(tree, "causes");
  v.group = get_claims(tree, "group");
  v.runners_up = get_claims(tree, "runners_up");
  if (const auto positions = tree.get_child_optional("positions")) {
    if (!positions->empty()) v.first = get_claims(positions->front().second, "not_distinguished");
  }
  v.unknown_share = tree.get<double>("unknown_share", 0.0);
  v.place = tree.get<std::string>("where.place", "");
  v.after = get_estimates(tree, "parameters.after");
  v.explained = get_number(tree, "gain.explained");
  v.map_share = get_number(tree, "force_map.hold_out_share");
  return v;
}

std::vector<TrueTrial> read_truths(const fs::path& folder) {
  std::istringstream sums(read_bytes(folder / "SHA256SUMS"));
  std::vector<TrueTrial> trials;
  std::string seal, name;
  while (sums >> seal >> name) {
    const fs::path path = folder / name;
    if (calc_sha256(read_bytes(path)) != seal) {
      throw std::runtime_error(path.string() + ": not the file that SHA256SUMS seals");
    }
    trials.push_back(read_truth(path));
  }
  if (trials.empty()) throw std::runtime_error(folder.string() + ": no truths");
  return trials;
}

}  // namespace strut::hidden
