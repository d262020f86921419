#include <cstdio>

#include "renderer/film/exr.hpp"
#include "server/limn/commands.hpp"
#include "server/limn/merge_parts.hpp"
#include "server/limn/output_file.hpp"

namespace limn {
namespace {

Result<std::vector<MergePart>> readParts(const std::vector<std::string>& files) {
  std::vector<MergePart> parts;
  for (const std::string& file : files) {
    Result<FilmImage> header = readExrWithoutPixels(file);
    if (!header) return header.error();
    Result<MergePart> part = mergePartOf(header.take(), file);
    if (!part) return part.error();
    parts.push_back(part.take());
  }
  return orderParts(std::move(parts));
}

Result<void> run(const Arguments& arguments) {
  const std::string output = arguments.text("output");
  if (!output.ends_with(".exr")) return usageError("--output must end in .exr, not '" + output + "'");
  if (Result<void> writable = checkWritable(output); !writable) return writable;
  const Result<std::vector<MergePart>> parts = readParts(arguments.positionals());
  if (!parts) return parts.error();

  PartMerger merger(parts->front());
  for (const MergePart& part : *parts) {
    const Result<FilmImage> image = readExr(part.place);
    if (!image) return image.error();
    if (Result<void> added = merger.add(part, *image); !added) return added;
  }
  if (Result<void> written = writeExr(output, merger.finish()); !written) return written;
  std::printf("%s: samples %s of %zu parts\n", output.c_str(),
              sampleRangeText({parts->front().range.first, parts->back().range.end}).c_str(), parts->size());
  return {};
}

}  // namespace

Command mergeCommand() {
  return {{"limn merge",
           "Puts the parts of one render, made with limn render --samples, together again.",
           {"PART.exr..."},
           {{"output", "FILE.exr", "where the whole goes; appears when it is complete", false, "", true}}},
          run};
}

}  // namespace limn
