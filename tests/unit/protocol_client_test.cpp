// The C++ client against a server that is scripted frame by frame.
#include <future>

#include <gtest/gtest.h>

#include "protocol/client/client.hpp"
#include "protocol/client/url.hpp"
#include "tests/unit/scripted_server.hpp"

namespace limn::protocol {
namespace {

using testing::ScriptedConnection;
using testing::ScriptedServer;

/// The script runs after the handshake.
std::function<void(ScriptedConnection&)> afterHandshake(std::function<void(ScriptedConnection&)> script) {
  return [script = std::move(script)](ScriptedConnection& connection) {
    connection.accept(connection.readRequest());
    script(connection);
  };
}

std::unique_ptr<Client> connectTo(const ScriptedServer& server, ClientOptions options = {}) {
  options.url = server.url();
  auto client = Client::connect(options);
  LIMN_CHECK(client.ok());
  return client.take();
}

std::string frame(uint32_t id, uint32_t ackSeq, FrameKind kind = FrameKind::image) {
  FrameHeader header;
  header.kind = kind;
  header.frameId = id;
  header.ackSeq = ackSeq;
  const std::vector<uint8_t> bytes = encodeFrame(header, std::vector<uint8_t>(100, uint8_t(id)));
  return {bytes.begin(), bytes.end()};
}

TEST(ProtocolClient, TheHandshakeNamesSubprotocolHostAndToken) {
  std::promise<std::string> request;
  ScriptedServer server([&](ScriptedConnection& connection) {
    const std::string text = connection.readRequest();
    connection.accept(text);
    request.set_value(text);
    connection.readFrame();
  });
  ClientOptions options;
  options.token = "c2VjcmV0";
  const auto client = connectTo(server, options);
  const std::string text = request.get_future().get();
  EXPECT_TRUE(text.starts_with("GET /ws HTTP/1.1\r\n")) << text;
  EXPECT_NE(text.find("Sec-WebSocket-Protocol: limn.v1\r\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Host: " + server.url().substr(5, server.url().size() - 8) + "\r\n"), std::string::npos) << text;
  EXPECT_NE(text.find("authorization: Bearer c2VjcmV0\r\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("Origin:"), std::string::npos) << text;
}

TEST(ProtocolClient, ARefusedHandshakeIsAnErrorWithItsStatus) {
  ScriptedServer server([](ScriptedConnection& connection) {
    connection.readRequest();
    connection.writeRaw("HTTP/1.1 403 Forbidden\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    connection.readFrame();
  });
  ClientOptions options;
  options.url = server.url();
  const auto client = Client::connect(options);
  ASSERT_FALSE(client.ok());
  EXPECT_EQ(client.error().code, "io");
  EXPECT_NE(client.error().message.find("403"), std::string::npos) << client.error().message;
}

TEST(ProtocolClient, NobodyListeningIsAnError) {
  std::string url;
  {
    ScriptedServer server([](ScriptedConnection&) {});
    url = server.url();
    ClientOptions options;
    options.url = url;
    EXPECT_FALSE(Client::connect(options).ok());
  }
  ClientOptions options;
  options.url = url;
  EXPECT_EQ(Client::connect(options).error().code, "io");
}

TEST(ProtocolClient, FragmentsWithAPingBetweenThemAreOneMessage) {
  std::promise<std::string> pong;
  ScriptedServer server(afterHandshake([&](ScriptedConnection& connection) {
    connection.write(1, R"({"op":"po)", false);
    connection.write(9, "are you there");
    connection.write(0, R"(ng","seq":7,)", false);
    connection.write(0, R"("serverSeconds":2})");
    const auto answer = connection.readFrame();
    pong.set_value(answer.opcode == 10 && answer.masked ? answer.payload : "no masked pong");
    connection.readFrame();
  }));
  const auto client = connectTo(server);
  const auto answer = client->answer<Pong>(7);
  ASSERT_TRUE(answer.ok()) << answer.error().text();
  EXPECT_EQ(answer->serverSeconds, 2.0);
  EXPECT_EQ(pong.get_future().get(), "are you there");
}

TEST(ProtocolClient, AnAnswerIsFoundBehindOthersWhichStayInOrder) {
  ScriptedServer server(afterHandshake([](ScriptedConnection& connection) {
    EXPECT_EQ(connection.readFrame().payload, R"({"op":"ping","seq":1})");
    connection.text(R"({"op":"bye","reason":"first"})");
    connection.text(R"({"op":"pong","seq":5,"serverSeconds":5})");
    connection.text(R"({"op":"pong","seq":1,"serverSeconds":1})");
    connection.readFrame();
  }));
  const auto client = connectTo(server);
  const auto answer = client->request<Pong>(Ping{});
  ASSERT_TRUE(answer.ok()) << answer.error().text();
  EXPECT_EQ(answer->seq, 1u);
  EXPECT_EQ(opOf(std::get<ReceivedMessage>(*client->nextEvent(5.0)).message), "bye");
  EXPECT_EQ(answeredSeq(std::get<ReceivedMessage>(*client->nextEvent(5.0)).message), 5u);
  EXPECT_FALSE(client->nextEvent(0.0).has_value());
}

TEST(ProtocolClient, AnErrorReplyComesBackAsAnError) {
  ScriptedServer server(afterHandshake([](ScriptedConnection& connection) {
    connection.readFrame();
    connection.text(R"({"op":"error","seq":1,"code":"io","message":"no such file","place":"a.glb"})");
    connection.readFrame();
  }));
  const auto answer = connectTo(server)->request<Loaded>(Load{0, "a.glb"});
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().code, "io");
  EXPECT_EQ(answer.error().place, "a.glb");
}

TEST(ProtocolClient, ImageFramesAreAcknowledgedOnArrivalAndFilesAreNot) {
  std::promise<std::vector<std::string>> acks;
  ScriptedServer server(afterHandshake([&](ScriptedConnection& connection) {
    connection.write(2, frame(8, 0, FrameKind::file));
    connection.write(2, frame(9, 0));
    connection.write(2, frame(10, 3));
    std::vector<std::string> all{connection.readFrame().payload};
    all.push_back(connection.readFrame().payload);
    acks.set_value(all);
    connection.readFrame();
  }));
  const auto client = connectTo(server);
  const auto shown = client->frameShowing(3);
  ASSERT_TRUE(shown.ok()) << shown.error().text();
  EXPECT_EQ(shown->header.frameId, 10u);
  EXPECT_EQ(shown->payload().size(), 100u);
  EXPECT_EQ(acks.get_future().get(), (std::vector<std::string>{R"({"op":"ackFrame","seq":1,"frameId":9,"dropped":false})",
                                                               R"({"op":"ackFrame","seq":2,"frameId":10,"dropped":false})"}));
}

TEST(ProtocolClient, ManualAcknowledgementsAreTheCallersMatter) {
  std::promise<std::string> first;
  ScriptedServer server(afterHandshake([&](ScriptedConnection& connection) {
    connection.write(2, frame(9, 1));
    first.set_value(connection.readFrame().payload);
    connection.readFrame();
  }));
  ClientOptions options;
  options.acks = FrameAcks::manual;
  const auto client = connectTo(server, options);
  ASSERT_TRUE(client->frameShowing(1).ok());
  client->send(Describe{});
  EXPECT_EQ(first.get_future().get(), R"({"op":"describe","seq":1})");
}

TEST(ProtocolClient, OnlyTheNewestImageIsKeptWhenAskedFor) {
  ScriptedServer server(afterHandshake([](ScriptedConnection& connection) {
    for (uint32_t id = 1; id <= 3; ++id) connection.write(2, frame(id, 0));
    connection.text(R"({"op":"pong","seq":1,"serverSeconds":1})");
    while (connection.readFrame().opcode != 8) {
    }
  }));
  ClientOptions options;
  options.newestFrameOnly = true;
  const auto client = connectTo(server, options);
  ASSERT_TRUE(client->answer<Pong>(1).ok());
  EXPECT_EQ(std::get<ReceivedFrame>(*client->nextEvent(5.0)).header.frameId, 3u);
  EXPECT_FALSE(client->nextEvent(0.0).has_value());
}

TEST(ProtocolClient, TheCloseCodeAndItsReasonAreTold) {
  ScriptedServer server(afterHandshake([](ScriptedConnection& connection) {
    connection.write(8, std::string("\x03\xF0", 2) + "no hello");
    connection.readFrame();
  }));
  const auto client = connectTo(server);
  const Closed closed = std::get<Closed>(*client->nextEvent(5.0));
  EXPECT_EQ(closed.code, 1008);
  EXPECT_EQ(closed.reason, "no hello");
  EXPECT_EQ(client->request<Pong>(Ping{}).error().code, "io");
}

TEST(ProtocolClient, AConnectionThatBreaksOffIsToldAsSuch) {
  ScriptedServer server(afterHandshake([](ScriptedConnection& connection) { connection.writeRaw("\x81\x7e"); }));
  EXPECT_EQ(std::get<Closed>(*connectTo(server)->nextEvent(5.0)).code, 1006);
}

TEST(ProtocolClient, ClosingSendsTheCode) {
  std::promise<std::string> payload;
  ScriptedServer server(afterHandshake([&](ScriptedConnection& connection) {
    const auto last = connection.readFrame();
    payload.set_value(last.opcode == 8 ? last.payload : "no close frame");
    connection.write(8, last.payload);
  }));
  const auto client = connectTo(server);
  client->close(kCloseNormal);
  EXPECT_EQ(payload.get_future().get(), std::string("\x03\xE8", 2));
  EXPECT_EQ(std::get<Closed>(*client->nextEvent(5.0)).code, 1000);
}

TEST(ProtocolClient, LongMessagesLeaveInMaskedFragments) {
  std::promise<std::vector<ScriptedConnection::WireFrame>> sent;
  ScriptedServer server(afterHandshake([&](ScriptedConnection& connection) {
    std::vector<ScriptedConnection::WireFrame> frames;
    do frames.push_back(connection.readFrame());
    while (!frames.back().final);
    sent.set_value(frames);
    connection.readFrame();
  }));
  const auto client = connectTo(server);
  std::string text(200'000, 'x');
  for (size_t i = 0; i < text.size(); ++i) text[i] = char('a' + i % 23);
  client->sendText(text);
  const auto frames = sent.get_future().get();
  ASSERT_EQ(frames.size(), 4u);
  std::string whole;
  for (const auto& piece : frames) {
    EXPECT_TRUE(piece.masked);
    EXPECT_LE(piece.payload.size(), kMaxFragmentBytes);
    whole += piece.payload;
  }
  EXPECT_EQ(frames[0].opcode, 1);
  EXPECT_EQ(frames[1].opcode, 0);
  EXPECT_EQ(whole, text);
}

TEST(ProtocolClient, WhatTheProtocolDoesNotAllowIsToldAsBroken) {
  ScriptedServer server(afterHandshake([](ScriptedConnection& connection) {
    std::string damaged = frame(1, 0);
    damaged.back() = 'x';
    connection.write(2, damaged);
    connection.text(R"({"op":"pong"})");
    connection.text(R"({"op":"of a later version"})");
    connection.text(R"({"op":"bye","reason":"done"})");
    connection.readFrame();
  }));
  const auto client = connectTo(server);
  EXPECT_EQ(std::get<Broken>(*client->nextEvent(5.0)).error.code, "bad-message");
  EXPECT_EQ(std::get<Broken>(*client->nextEvent(5.0)).error.place, "/seq");
  EXPECT_TRUE(std::holds_alternative<ReceivedMessage>(*client->nextEvent(5.0)));
}

TEST(ProtocolClient, TheRecorderSeesBothDirections) {
  ScriptedServer server(afterHandshake([](ScriptedConnection& connection) {
    connection.readFrame();
    connection.write(2, frame(1, 0));
    connection.text(R"({"op":"pong","seq":1,"serverSeconds":1})");
    connection.readFrame();
  }));
  TrafficRecorder recorder;
  ClientOptions options;
  options.recorder = &recorder;
  options.acks = FrameAcks::manual;
  ASSERT_TRUE(connectTo(server, options)->request<Pong>(Ping{}).ok());
  EXPECT_EQ(recorder.seen(), (std::set<std::string>{"client ping", "frame image", "server pong"}));
}

TEST(ProtocolClient, AddressesAreRead) {
  const auto said = [](std::string_view text) {
    const auto url = parseServerUrl(text);
    return url ? (url->tls ? "wss " : "ws ") + url->host + " " + std::to_string(url->port) + " " + url->path : "refused";
  };
  EXPECT_EQ(said("ws://127.0.0.1:8080/ws"), "ws 127.0.0.1 8080 /ws");
  EXPECT_EQ(said("http://localhost:8080/"), "ws localhost 8080 /ws");
  EXPECT_EQ(said("http://localhost/limn/"), "ws localhost 80 /limn/ws");
  EXPECT_EQ(said("localhost:9000"), "ws localhost 9000 /ws");
  EXPECT_EQ(said("wss://host/a/ws?token=x"), "wss host 443 /a/ws?token=x");
  EXPECT_EQ(said("ws://[::1]:8080/ws"), "ws ::1 8080 /ws");
  for (const char* bad : {"", "ftp://host/", "ws://", "ws://:80/", "ws://host:0/", "ws://host:99999/", "ws://host:8o/", "ws://[::1/"})
    EXPECT_EQ(said(bad), "refused") << bad;
}

}  // namespace
}  // namespace limn::protocol
