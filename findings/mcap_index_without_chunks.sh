#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: @mcap/core 2.2.2 (npm), writer and readers of MCAP.
# One would guess: McapIndexedReader reads what McapWriter wrote, or refuses it.
# What happens: of a file without chunks, which the format allows and the writer offers, readMessages() yields nothing: no
#   error, while statistics.messageCount of the same reader counts all messages. McapStreamReader finds each of them.
# Seen: five messages, useChunks false: indexed 0, counted 5, streamed 5; with chunks 5, 5, 5.
# Why it matters: a logger with little memory leaves chunks out, as it has to hold no rows back. Its flight reads as empty.
# pinnquad: import refuses MCAP by its first bytes, with the commands that make a table of it (docs/formats.md).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" @mcap/core@2.2.2 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install @mcap/core"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { McapIndexedReader, McapStreamReader, McapWriter, TempBuffer } = require('@mcap/core');
const found = async (useChunks) => {
  const file = new TempBuffer(), writer = new McapWriter({ writable: file, useChunks });
  await writer.start({ profile: '', library: '' });
  const channelId = await writer.registerChannel({ topic: '/imu', messageEncoding: 'json', schemaId: 0, metadata: new Map() });
  for (let i = 0; i < 5; ++i) {
    const logTime = BigInt(i) * 4000000n;
    await writer.addMessage({ channelId, sequence: i, logTime, publishTime: logTime, data: Buffer.from('{"gyro_x":0.1}') });
  }
  await writer.end();
  const reader = await McapIndexedReader.Initialize({ readable: file }), stream = new McapStreamReader();
  let indexed = 0, streamed = 0;
  for await (const message of reader.readMessages()) indexed += message.data.length > 0;
  stream.append(file.get());
  for (let record; (record = stream.nextRecord()); ) streamed += record.type === 'Message';
  return [indexed, Number(reader.statistics.messageCount), streamed];
};
(async () => {
  const without = await found(false), chunked = await found(true);
  console.log(`indexed, counted, streamed: ${without} without chunks, ${chunked} with`);
  if (without.join() === '0,5,5' && chunked.join() === '5,5,5') process.exit(0);
  console.log('changed: what the indexed reader finds in a file without chunks');
  process.exit(1);
})();
JS
node "$dir/observe.cjs"
