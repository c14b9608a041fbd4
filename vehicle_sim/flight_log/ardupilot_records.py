"""The records of ArduCopter 4.6 that this vehicle writes: types, fields, units, multipliers."""

from __future__ import annotations

from typing import Final

from vehicle_sim.flight_log.dataflash import Record

# fmt: off
PARM = Record(32, "PARM", "QNff", "TimeUS,Name,Value,Default", "s---", "F---")
MSG = Record(35, "MSG", "QZ", "TimeUS,Message", "s-", "F-")
VER = Record(203, "VER", "QBHBBBBIZHBBII",
             "TimeUS,BT,BST,Maj,Min,Pat,FWT,GH,FWS,APJ,BU,FV,IMI,ICI",
             "s-------------", "F-------------")
MODE = Record(109, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn", "s---", "F---")
EV = Record(160, "EV", "QB", "TimeUS,Id", "s-", "F-")
ORGN = Record(71, "ORGN", "QBLLe", "TimeUS,Type,Lat,Lng,Alt", "s#DUm", "F-GGB")
ATT = Record(72, "ATT", "QffffffB", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,AEKF",
             "sddddhh-", "F000000-")
POS = Record(73, "POS", "QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt", "sDUmmm", "FGG000")
GPS = Record(150, "GPS", "QBBIHBcLLeffffB",
             "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U",
             "s#-s-S-DUmnhnh-", "F--C-0BGGB000--")
BAT = Record(151, "BAT", "QBfffffcfBBB",
             "TimeUS,Inst,Volt,VoltR,Curr,CurrTot,EnrgTot,Temp,Res,RemPct,H,SH",
             "s#vvAaXOw%-%", "F-000C0?0000")
XKF1 = Record(152, "XKF1", "QBccCfffffffccce",
              "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH",
              "s#ddhnnnnmmmkkkm", "F-BBB0000000BBBB")
CTUN = Record(4, "CTUN", "Qffffffefffhh",
              "TimeUS,ThI,ABst,ThO,ThH,DAlt,Alt,BAlt,DSAlt,SAlt,TAlt,DCRt,CRt",
              "s----mmmmmmnn", "F----00B000BB")
IMU = Record(153, "IMU", "QBffffffIIfBBHH",
             "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz",
             "s#EEEooo--O--zz", "F-000000-----00")
MAG = Record(158, "MAG", "QBhhhhhhhhhBI",
             "TimeUS,I,MagX,MagY,MagZ,OfsX,OfsY,OfsZ,MOX,MOY,MOZ,Health,S",
             "s#GGGGGGGGG-s", "F-CCCCCCCCC-F")
RATE = Record(74, "RATE", "Qfffffffffffff",
              "TimeUS,RDes,R,ROut,PDes,P,POut,YDes,Y,YOut,ADes,A,AOut,AOutSlew",
              "skk-kk-kk-oo--", "F?????????BB--")
RCOU = Record(154, "RCOU", "QHHHHHHHHHHHHHH",
              "TimeUS,C1,C2,C3,C4,C5,C6,C7,C8,C9,C10,C11,C12,C13,C14",
              "sYYYYYYYYYYYYYY", "F--------------")
PSC = tuple(
    Record(155 + number, f"PSC{axis}", "Qffffffff",
           f"TimeUS,TP{axis},P{axis},DV{axis},TV{axis},V{axis},DA{axis},TA{axis},A{axis}",
           "smmnnnooo", "F00000000")
    for number, axis in enumerate("NED")
)
# fmt: on

RECORDS: Final = (
    *(PARM, MSG, VER, MODE, EV, ORGN, ATT, POS, GPS, BAT, XKF1, CTUN, IMU, MAG, RATE, RCOU),
    *PSC,
)
