#include "renderer/film/exr_layers.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

namespace limn {
namespace {

const std::string kMain = "beauty";
const std::string kMainChannels[] = {"R", "G", "B", "Y", "A"};

std::string prefixOf(const std::string& channel) {
  if (std::find(std::begin(kMainChannels), std::end(kMainChannels), channel) != std::end(kMainChannels)) return kMain;
  return channel.substr(0, channel.rfind('.'));
}

std::string suffixOf(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == channel.npos ? channel : channel.substr(dot + 1);
}

using Group = std::map<std::string, size_t>;  // suffix -> index in the file

std::optional<std::vector<size_t>> triple(const Group& group, std::string_view suffixes) {
  std::vector<size_t> sources;
  for (const char suffix : suffixes) {
    const auto found = group.find(std::string(1, suffix));
    if (found == group.end()) return std::nullopt;
    sources.push_back(found->second);
  }
  return sources;
}

}  // namespace

std::vector<std::string> exrChannelNames(const FilmLayer& layer) {
  const bool main = layer.name == kMain;
  if (layer.channels == 1) {
    if (main) return {"Y"};
    return {layer.name == "depth" ? "depth.Z" : layer.name};
  }
  std::vector<std::string> names;
  for (const char suffix : std::string(layer.name == "normal" ? "XYZ" : "RGB"))
    names.push_back(main ? std::string(1, suffix) : layer.name + "." + suffix);
  return names;
}

std::vector<ExrLayerPlan> planExrLayers(const std::vector<std::string>& channels) {
  std::map<std::string, Group> groups;
  for (size_t i = 0; i < channels.size(); ++i) groups[prefixOf(channels[i])].emplace(suffixOf(channels[i]), i);

  std::vector<ExrLayerPlan> plans;
  for (auto& [prefix, group] : groups) {
    for (const std::string_view suffixes : {"RGB", "XYZ"}) {
      const std::optional<std::vector<size_t>> sources = triple(group, suffixes);
      if (!sources) continue;
      plans.push_back({prefix, *sources});
      for (const char suffix : suffixes) group.erase(std::string(1, suffix));
      break;
    }
    const bool alone = group.size() == 1 && (plans.empty() || plans.back().name != prefix);
    for (const auto& [suffix, source] : group) plans.push_back({alone ? prefix : channels[source], {source}});
  }
  std::stable_partition(plans.begin(), plans.end(), [](const ExrLayerPlan& plan) { return plan.name == kMain; });
  return plans;
}

}  // namespace limn
