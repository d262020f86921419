#pragma once
#include <string>
#include <vector>

#include "protocol/messages.gen.hpp"
#include "renderer/session/messages.hpp"
#include "renderer/techniques/technique_info.hpp"

namespace limn::server {

/// The wire's structs and the renderer's, field by field. `present` gives what a camera edit leaves out of its lens.
View viewFromWire(const protocol::View& wire, const View& present);
protocol::View toWire(const View& view);
/// A camera edit becomes the next one's `present`.
Edit editFromWire(const protocol::Edit& wire, View& present);

protocol::SceneMessage toWire(const SceneSummary& scene, protocol::SceneCause cause);
protocol::Status toWire(const Status& status);
protocol::Ack toWire(const EditAck& ack);
protocol::Picked toWire(const PickReply& reply);
protocol::Waited toWire(const WaitReply& reply);
std::vector<protocol::Technique> toWire(const std::vector<TechniqueInfo>& techniques);

/// The header of a picture for one client, but for what only the caller knows: encoding, quality, replaced, encodeMs,
/// payload and crc. `stages` names the entries of stageMs.
protocol::FrameHeader frameHeader(const FrameInfo& info, uint64_t client, const std::vector<std::string>& stages);

}  // namespace limn::server
