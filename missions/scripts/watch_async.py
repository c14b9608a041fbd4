"""With asyncio: legs in every manner, while another task watches the battery and may stop them."""

import asyncio
import sys

import gcs


async def watch(station: gcs.AsyncStation, least_pct: int) -> None:
    battery = await station.telemetry("BATTERY_STATUS")
    while battery["battery_remaining"] >= least_pct:
        await asyncio.sleep(0.5)
        battery = await station.telemetry("BATTERY_STATUS")
    await station.abort()


async def main(link: str | None, least_pct: int = 30) -> None:
    async with gcs.aconnect(link, sim=link is None, name="watch_async") as station:
        await station.arm()
        await station.takeoff(3)
        watching = asyncio.create_task(watch(station, least_pct))
        try:
            await station.goto(3, 0, 3, yaw_deg=0)
            await station.move(north_m=2)
            await station.heading(90)
            await station.forward(2, up_m=1)
            print("at", station.position_enu)
        except gcs.NotCompleted as ended:
            print(ended.state, ended.code)
        watching.cancel()
        await station.land()
        print(station.state, station.log_path)


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1] if len(sys.argv) > 1 else None))
