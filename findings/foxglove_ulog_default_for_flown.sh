#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: @foxglove/ulog 2.3.2 (npm), a reader of PX4's logs.
# One would guess: header.parameters holds the values that flew ('P'); a default ('Q') of a parameter that was changed is
#   beside it.
# What happens: both are one entry, and the message that comes later wins. PX4 writes its defaults after the parameters: of each
#   parameter that the pilot had changed the default is reported, and what flew is nowhere.
# Seen: MC_ROLLRATE_P = 0.25 ('P'), default 0.15 ('Q'): the reader reports 0.15. The other order gives 0.25. A log of PX4 has
#   60 to 100 such defaults, each of a parameter that was changed.
# Why it matters: it is right for all parameters but those that were tuned: gains, thrust curves, rotor geometry.
# pinnquad: import reads what flew, as it was at the start; defaults are left out (tools/logs/ulog.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" @foxglove/ulog@2.3.2 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install @foxglove/ulog"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { ULog } = require('@foxglove/ulog');
const { FileReader } = require('@foxglove/ulog/node');
const { writeFileSync } = require('fs');
const little = (bytes, write) => { const b = Buffer.alloc(bytes); b[write[0]](write[1]); return b; };
const message = (type, ...parts) => {
  const content = Buffer.concat(parts);
  return Buffer.concat([little(2, ['writeUInt16LE', content.length]), Buffer.from(type), content]);
};
const gain = (value) => Buffer.concat([Buffer.from('\x13float MC_ROLLRATE_P'), little(4, ['writeFloatLE', value])]);
const flown = message('P', gain(0.25)), byDefault = message('Q', Buffer.from([1]), gain(0.15));
const reported = async (...parameters) => {
  const begin = Buffer.from([0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35, 1, ...Array(8).fill(0)]);
  const topic = [message('F', Buffer.from('imu:uint64_t timestamp;')), message('A', Buffer.from('\0\0\0imu'))];
  const row = message('D', Buffer.alloc(2), little(8, ['writeBigUInt64LE', 1000n]));
  const path = `${__dirname}/log.ulg`;
  writeFileSync(path, Buffer.concat([begin, topic[0], ...parameters, topic[1], row]));
  const log = new ULog(new FileReader(path));
  await log.open();
  return log.header.parameters.get('MC_ROLLRATE_P').value.toFixed(2);
};
(async () => {
  const usual = await reported(flown, byDefault), other = await reported(byDefault, flown);
  console.log(`0.25 flew, 0.15 is the default: reported ${usual}, in the other order ${other}`);
  if (usual === '0.15' && other === '0.25') process.exit(0);
  console.log('changed: what is reported of a parameter that has a default');
  process.exit(1);
})();
JS
node "$dir/observe.cjs"
