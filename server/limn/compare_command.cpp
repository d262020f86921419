#include <algorithm>
#include <cmath>
#include <cstdio>

#include "protocol/json_writer.hpp"
#include "renderer/film/compare.hpp"
#include "renderer/film/exr.hpp"
#include "server/limn/commands.hpp"
#include "server/limn/output_file.hpp"

namespace limn {
namespace {

const std::vector<std::string> kMetrics = {"relmse", "rmse", "mape", "psnr"};

struct Pictures {
  FilmImage picture, mean;
  std::optional<FilmImage> half0, half1;
};

Result<std::vector<std::string>> chosenMetrics(const Arguments& arguments) {
  if (!arguments.has("metric")) return kMetrics;
  const std::vector<std::string> chosen = arguments.list("metric");
  for (const std::string& name : chosen)
    if (std::find(kMetrics.begin(), kMetrics.end(), name) == kMetrics.end())
      return usageError("unknown metric '" + name + "'; there are relmse, rmse, mape and psnr");
  if (chosen.empty()) return usageError("--metric needs at least one name");
  return chosen;
}

Result<Pictures> readPictures(const Arguments& arguments) {
  const std::vector<std::string> halves = arguments.list("halves");
  if (arguments.has("halves") && halves.size() != 2) return usageError("--halves takes two files, H0.exr,H1.exr");
  Result<FilmImage> picture = readExr(arguments.positionals()[0]);
  if (!picture) return picture.error();
  Result<FilmImage> mean = readExr(arguments.positionals()[1]);
  if (!mean) return mean.error();
  Pictures pictures{picture.take(), mean.take(), {}, {}};
  if (halves.empty()) return pictures;
  Result<FilmImage> half0 = readExr(halves[0]);
  if (!half0) return half0.error();
  Result<FilmImage> half1 = readExr(halves[1]);
  if (!half1) return half1.error();
  pictures.half0 = half0.take();
  pictures.half1 = half1.take();
  return pictures;
}

Result<Reference> referenceOf(const Pictures& pictures, const Arguments& arguments) {
  const Result<RadianceView> mean = radianceOf(pictures.mean, arguments.positionals()[1]);
  if (!mean) return mean.error();
  Reference reference{*mean, {}, {}};
  if (!pictures.half0) return reference;
  const std::vector<std::string> names = arguments.list("halves");
  const Result<RadianceView> half0 = radianceOf(*pictures.half0, names[0]);
  if (!half0) return half0.error();
  const Result<RadianceView> half1 = radianceOf(*pictures.half1, names[1]);
  if (!half1) return half1.error();
  reference.half0 = *half0;
  reference.half1 = *half1;
  return reference;
}

struct NamedValue {
  std::string name;
  std::optional<double> value;
};

/// The values of the chosen metrics, named as the JSON names them.
std::vector<NamedValue> valuesOf(const ErrorMetrics& metrics, const std::vector<std::string>& chosen) {
  std::vector<NamedValue> values;
  for (const std::string& name : chosen) {
    if (name == "relmse") {
      values.push_back({"relmse", metrics.relMse});
      values.push_back({"relmseAll", metrics.relMseAll});
    }
    if (name == "rmse") values.push_back({name, metrics.rmse});
    if (name == "mape") values.push_back({name, metrics.mape});
    if (name == "psnr") values.push_back({name, metrics.psnr});
  }
  return values;
}

void printText(const std::string& prefix, const std::vector<NamedValue>& values) {
  for (const NamedValue& entry : values) {
    const std::string name = prefix + entry.name;
    if (entry.value) std::printf("%-14s %.6g\n", name.c_str(), *entry.value);
    else std::printf("%-14s not defined with halves\n", name.c_str());
  }
}

void writeFields(protocol::JsonWriter& json, const std::vector<NamedValue>& values) {
  for (const NamedValue& entry : values)
    json.field(entry.name, entry.value.value_or(std::nan("")));  // null in JSON
}

Result<void> writeHeatmap(const std::string& file, const RadianceView& picture, const Reference& reference) {
  const Result<std::vector<double>> quotients = relativeSquares(picture, reference);
  if (!quotients) return quotients.error();
  return writePng(file, picture.width, picture.height, errorHeatmap(picture.width, picture.height, *quotients));
}

Result<void> run(const Arguments& arguments) {
  const Result<std::vector<std::string>> chosen = chosenMetrics(arguments);
  if (!chosen) return chosen.error();
  const std::string heatmap = arguments.text("heatmap");
  if (arguments.has("heatmap"))
    if (Result<void> writable = checkWritable(heatmap); !writable) return writable;
  const Result<Pictures> pictures = readPictures(arguments);
  if (!pictures) return pictures.error();
  const Result<RadianceView> picture = radianceOf(pictures->picture, arguments.positionals()[0]);
  if (!picture) return picture.error();
  const Result<Reference> reference = referenceOf(*pictures, arguments);
  if (!reference) return reference.error();

  const Result<ErrorMetrics> metrics = compareImages(*picture, *reference);
  if (!metrics) return metrics.error();
  const std::vector<NamedValue> values = valuesOf(*metrics, *chosen);
  std::vector<NamedValue> low;
  if (arguments.has("low")) {
    const Result<ErrorMetrics> averaged = compareLow(*picture, *reference);
    if (!averaged) return averaged.error();
    low = valuesOf(*averaged, *chosen);
  }
  if (arguments.has("heatmap"))
    if (Result<void> written = writeHeatmap(heatmap, *picture, *reference); !written) return written;

  if (arguments.has("json")) {
    protocol::JsonWriter json;
    json.beginObject();
    writeFields(json, values);
    if (!low.empty()) {
      json.key("low");
      json.beginObject();
      writeFields(json, low);
      json.endObject();
    }
    json.field("nonFinite", metrics->nonFinite);
    json.endObject();
    std::printf("%s\n", json.take().c_str());
    return {};
  }
  printText("", values);
  printText("low.", low);
  if (metrics->nonFinite > 0) std::printf("%-14s %s\n", "nonFinite", std::to_string(metrics->nonFinite).c_str());
  return {};
}

}  // namespace

Command compareCommand() {
  return {{"limn compare",
           "Measures a picture against a reference: relmse leaves out the 0.1 % largest quotients, relmseAll does not.",
           {"A.exr", "REF.exr"},
           {{"metric", "relmse,rmse,mape,psnr", "which measures (default: all four)"},
            {"heatmap", "OUT.png", "write where the error is, 1e-4 dark to 10 light, logarithmic"},
            {"json", "", "one JSON object on stdout instead of lines"},
            {"halves", "H0.exr,H1.exr", "two independent halves of the reference: its own noise no longer counts"},
            {"low", "", "also after averaging 16x16 blocks: noise nearly gone, bias stays"}}},
          run};
}

}  // namespace limn
