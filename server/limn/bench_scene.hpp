#pragma once
#include "server/limn/bench_results.hpp"

namespace limn::bench {

/// One line of --pictures: a picture that another renderer made of a scene.
struct PeerPicture {
  std::string scene, renderer, file;
  double seconds = 0.0;                ///< of rendering
};
/// Reads lines of scene,name,seconds,file.exr; files are found beside the list. Lines that begin with "scene," or # are
/// passed over. Errors: "io", "bad-file" with the line.
Result<std::vector<PeerPicture>> readPeerPictures(const std::string& list);

/// Every technique and seed on one scene, one after the other, then the reference, then the figures. Errors: those of
/// loading, of the session and of files, with the scene as their place.
Result<SceneResult> measureScene(vk::Device& device, const std::string& file, const BenchOptions& options,
                                 const std::vector<PeerPicture>& peers);

}  // namespace limn::bench
