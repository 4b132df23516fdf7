// Flies the emulated drone with tello-drone; arguments: address, port, folder with node_modules.
"use strict";

const [address, port, modules] = process.argv.slice(2);
// tello-drone binds the drone's port locally on all addresses; on one machine that port is taken by the drone.
const dgram = require("dgram");
const create = dgram.createSocket;
dgram.createSocket = (...kind) => {
    const socket = create(...kind);
    const bind = socket.bind.bind(socket);
    socket.bind = local => bind(local === port ? 0 : local);
    return socket;
};
const { connect } = require(`${modules}/tello-drone`);

async function main() {
    const drone = connect({ host: address, port });
    await new Promise(resolve => drone.on("connection", resolve));
    let states = 0;
    drone.on("state", () => { states += 1; });
    const said = [];
    drone.on("message", message => said.push(String(message).trim()));
    const answered = async count => {
        while (said.length < count) await new Promise(resolve => setTimeout(resolve, 20));
    };
    const steps = [["takeoff"], ["forward", { value: 50 }], ["cw", { value: 90 }], ["land"]];
    for (const [index, [command, options]] of steps.entries()) {
        await drone.send(command, options);
        await answered(index + 1);
        if (said[index] !== "ok") throw new Error(`${command}: ${said[index]}`);
    }
    if (states === 0) throw new Error("no state line was parsed");
    console.log(`tello-drone: flown, ${states} states`);
    process.exit(0);
}

main().catch(error => { console.error(error); process.exit(1); });
setTimeout(() => { console.error("tello-drone: timed out"); process.exit(1); }, 60000);
