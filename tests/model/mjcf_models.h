// MJCF models of the usual kinds, for comparisons with MuJoCo.
#pragma once

#include <array>
#include <string_view>

namespace limber::model::test {

struct MjcfModel {
  std::string_view name;
  std::string_view text;
};

inline constexpr std::array<MjcfModel, 11> kMjcfModels{{
    {"humanoid", R"(<mujoco model="humanoid"><compiler angle="degree" inertiafromgeom="true" autolimits="true"/>
<default><geom density="900" condim="1"/><joint armature=".01" damping="1"/>
 <motor ctrllimited="true" ctrlrange="-1 1"/>
 <default class="leg"><joint limited="true" stiffness="1"/><geom rgba=".2 .6 .4 1"/></default></default>
<worldbody><geom name="floor" type="plane" size="5 5 1" conaffinity="1"/><light pos="0 0 3"/>
<body name="torso" pos="0 0 1.4"><camera name="track" pos="0 -4 0"/><freejoint name="root"/>
 <geom name="chest" type="capsule" fromto="0 -.07 0 0 .07 0" size=".07"/><geom name="head" pos="0 0 .19" size=".09"/>
 <site name="imu" pos="0 0 .05"/>
 <body name="lower" pos="-.01 0 -.26" quat="1 0 -.002 0">
  <joint name="abdomen_z" pos="0 0 .065" axis="0 0 1" range="-45 45"/>
  <joint name="abdomen_y" pos="0 0 .065" axis="0 1 0" range="-75 30"/>
  <geom name="waist" type="capsule" fromto="0 -.06 0 0 .06 0" size=".06"/>
  <body name="thigh" pos="0 -.1 -.04" childclass="leg">
   <joint name="hip_x" axis="1 0 0" range="-25 5"/><joint name="hip_z" axis="0 0 1" range="-60 35"/>
   <joint name="hip_y" axis="0 1 0" range="-110 20"/>
   <geom type="capsule" fromto="0 0 0 0 .01 -.34" size=".06"/>
   <body name="shin" pos="0 .01 -.403"><joint name="knee" pos="0 0 .02" axis="0 -1 0" range="-160 -2"/>
    <geom type="capsule" fromto="0 0 0 0 0 -.3" size=".049"/>
    <body name="foot" pos="0 0 -.39"><joint name="ankle_y" axis="0 1 0" range="-50 50"/>
     <joint name="ankle_x" axis="1 0 .5" range="-50 50"/>
     <geom type="capsule" fromto="-.07 -.02 0 .14 -.04 0" size=".027"/><geom type="capsule" fromto="-.07 0 0 .14 .02 0" size=".027"/>
 </body></body></body></body></body></worldbody>
<actuator><motor name="a" joint="abdomen_z" gear="40"/><motor joint="hip_x" gear="40"/><motor joint="knee" gear="80"/></actuator></mujoco>)"},
    {"ant", R"(<mujoco model="ant"><compiler angle="degree" coordinate="local" inertiafromgeom="true"/>
<option integrator="RK4" timestep="0.01"/>
<default><joint armature="1" damping="1" limited="true"/><geom conaffinity="0" condim="3" density="5.0" rgba="0.8 0.6 0.4 1"/></default>
<worldbody><geom conaffinity="1" condim="3" name="floor" pos="0 0 0" size="40 40 40" type="plane"/>
<body name="torso" pos="0 0 0.75"><geom name="torso_geom" pos="0 0 0" size="0.25" type="sphere"/>
 <joint armature="0" damping="0" limited="false" margin="0.01" name="root" pos="0 0 0" type="free"/>
 <body name="front_left_leg" pos="0 0 0"><geom fromto="0 0 0 0.2 0.2 0" size="0.08" type="capsule"/>
  <body name="aux_1" pos="0.2 0.2 0"><joint axis="0 0 1" name="hip_1" pos="0 0 0" range="-30 30" type="hinge"/>
   <geom fromto="0 0 0 0.2 0.2 0" size="0.08" type="capsule"/>
   <body pos="0.2 0.2 0"><joint axis="-1 1 0" name="ankle_1" pos="0 0 0" range="30 70" type="hinge"/>
    <geom fromto="0 0 0 0.4 0.4 0" size="0.08" type="capsule"/></body></body></body>
 <body name="back_leg" pos="0 0 0"><geom fromto="0 0 0 -0.2 -0.2 0" size="0.08" type="capsule"/>
  <body name="aux_2" pos="-0.2 -0.2 0"><joint axis="0 0 1" name="hip_2" range="-30 30" type="hinge"/>
   <geom fromto="0 0 0 -0.2 -0.2 0" size="0.08" type="capsule"/></body></body></body></worldbody>
<actuator><motor ctrllimited="true" ctrlrange="-1 1" joint="hip_1" gear="150"/></actuator></mujoco>)"},
    {"hopper", R"(<mujoco model="hopper"><compiler angle="degree" inertiafromgeom="true"/>
<default><joint armature="1" damping="1" limited="true"/><geom conaffinity="1" condim="1" contype="1" margin="0.001"/></default>
<worldbody><geom name="floor" type="plane" size="20 20 .125" conaffinity="1"/>
<body name="torso" pos="0 0 1.25"><joint armature="0" axis="1 0 0" damping="0" limited="false" name="rootx" pos="0 0 -1.25" type="slide"/>
 <joint armature="0" axis="0 0 1" damping="0" limited="false" name="rootz" ref="1.25" pos="0 0 -1.25" type="slide"/>
 <joint armature="0" axis="0 1 0" damping="0" limited="false" name="rooty" type="hinge"/>
 <geom fromto="0 0 0.2 0 0 -0.2" name="torso_geom" size="0.05" type="capsule"/>
 <body name="thigh" pos="0 0 -0.2"><joint axis="0 -1 0" name="thigh_joint" range="-150 0" type="hinge"/>
  <geom fromto="0 0 0 0 0 -0.45" name="thigh_geom" size="0.05" type="capsule"/></body></body></worldbody></mujoco>)"},
    {"global", R"(<mujoco model="global"><compiler angle="degree" coordinate="global" inertiafromgeom="true"/>
<worldbody><body name="torso" pos="0 0 1.25"><joint axis="1 0 0" name="rootx" pos="0 0 0" type="slide"/>
 <joint axis="0 1 0" name="rooty" pos="0 0 1.25" type="hinge"/><geom fromto="0 0 1.45 0 0 1.05" size="0.05" type="capsule"/>
 <body name="thigh" pos="0.1 0 1.05" euler="0 30 10"><joint axis="0 -1 0" pos="0 0 1.05" type="hinge"/>
  <geom fromto="0 0 1.05 0 0.1 0.6" size="0.05" type="capsule"/><geom size=".02 .03 .04" type="box"/>
  <body name="leg" pos="0 0 0.35"><joint axis="0 -1 0" pos="0 0 0.6"/><geom pos="0 .1 .4" euler="10 0 0" size=".02 .2 .04" type="box"/>
 </body></body></body></worldbody></mujoco>)"},
    {"cheetah",
     R"(<mujoco model="cheetah"><compiler angle="radian" coordinate="local" inertiafromgeom="true" settotalmass="14"/>
<default><joint armature=".1" damping=".01" limited="true" solimplimit="0 .8 .03" stiffness="8"/>
 <geom conaffinity="0" condim="3" contype="1" rgba="0.8 0.6 .4 1"/><motor ctrllimited="true" ctrlrange="-1 1"/></default>
<worldbody><geom conaffinity="1" name="floor" size="40 40 40" type="plane"/>
<body name="torso" pos="0 0 .7"><joint axis="1 0 0" damping="0" limited="false" name="rootx" stiffness="0" type="slide"/>
 <joint axis="0 0 1" damping="0" limited="false" name="rootz" stiffness="0" type="slide"/>
 <joint axis="0 1 0" damping="0" limited="false" name="rooty" stiffness="0" type="hinge"/>
 <geom fromto="-.5 0 0 .5 0 0" name="torso" size="0.046" type="capsule"/>
 <geom axisangle="0 1 0 .87" name="head" pos=".6 0 .1" size="0.046 .15" type="capsule"/>
 <body name="bthigh" pos="-.5 0 0"><joint axis="0 1 0" damping="6" name="bthigh" range="-.52 1.05" stiffness="240" type="hinge"/>
  <geom axisangle="0 1 0 -3.8" name="bthigh" pos=".1 0 -.13" size="0.046 .145" type="capsule"/>
  <body name="bshin" pos=".16 0 -.25"><joint axis="0 1 0" name="bshin" range="-.785 .785" type="hinge"/>
   <geom axisangle="0 1 0 -2.03" pos="-.14 0 -.07" size="0.046 .15" type="capsule" rgba="0.9 0.6 0.6 1"/></body></body></body></worldbody>
<actuator><motor gear="120" joint="bthigh" name="bthigh"/><motor gear="90" joint="bshin" name="bshin"/></actuator></mujoco>)"},
    {"walker", R"(<mujoco model="walker"><compiler angle="degree" autolimits="true" eulerseq="zyx"/>
<default><default class="walker"><geom type="capsule" friction=".7"/><joint axis="0 -1 0" damping=".1"/>
 <default class="foot"><geom size=".05"/></default></default></default>
<worldbody><body name="torso" pos="0 0 1.3" childclass="walker"><joint name="rootz" axis="0 0 1" type="slide"/>
 <joint name="rootx" axis="1 0 0" type="slide"/><joint name="rooty" axis="0 1 0"/><geom name="torso" size="0.07 0.3"/>
 <body name="right_thigh" pos="0 -.05 -0.3" euler="20 10 -30"><joint name="right_hip" range="-20 100"/>
  <geom name="right_thigh" pos="0 0 -0.225" size="0.05 0.225"/>
  <body name="right_foot" pos="0.06 0 -0.5" zaxis="1 0 0"><joint name="right_ankle" range="-45 45" pos="-.1 0 .1"/>
   <geom class="foot" zaxis="0 1 1" size="0.05 0.1"/><geom class="foot" type="sphere"/></body></body></body></worldbody></mujoco>)"},
    {"swimmer",
     R"(<mujoco model="swimmer"><compiler angle="degree" coordinate="local" inertiafromgeom="auto" boundmass="0.1" boundinertia="0.002"/>
<option density="4000" viscosity="0.1"/><default><geom density="1000" type="capsule"/></default>
<worldbody><body name="torso"><geom fromto="1.5 0 0 0.5 0 0" size="0.1"/>
 <joint axis="1 0 0" name="slider1" type="slide"/><joint axis="0 1 0" name="slider2" type="slide"/><joint axis="0 0 1" name="rot" type="hinge"/>
 <body name="mid" pos="0.5 0 0"><geom fromto="0 0 0 -1 0 0" size="0.1"/><joint axis="0 0 1" limited="true" name="rot2" range="-100 100" type="hinge"/>
  <body name="back" pos="-1 0 0"><geom type="cylinder" fromto="0 0 0 -1 0 0" size="0.1"/><joint axis="0 0 1" limited="true" name="rot3" range="-100 100" type="hinge"/>
   <body name="tail" pos="-1 0 0"><geom type="sphere" size=".01"/><joint axis="0 0 1" name="rot4"/></body></body></body></body></worldbody></mujoco>)"},
    {"arm", R"(<mujoco model="arm"><compiler angle="radian" autolimits="true" balanceinertia="true"/>
<worldbody><body name="base" pos=".1 .2 .3" axisangle="0 0 1 .5"><geom type="cylinder" size=".1 .05" mass="3"/>
 <geom type="box" size=".02 .03 .1" pos="0 0 .1" euler=".1 .2 .3" mass=".5"/>
 <body name="upper" pos="0 0 .2"><inertial pos="0 0 .15" quat=".9 .1 .2 .3" mass="2" diaginertia=".02 .015 .01"/>
  <joint name="shoulder" type="ball"/><geom type="capsule" fromto="0 0 0 0 0 .3" size=".04"/>
  <body name="lower" pos="0 0 .3" xyaxes="0 1 0 1 0 0"><joint name="elbow" axis="0 1 0" range="-2 2"/>
   <inertial pos="0 0 .1" mass="1" fullinertia=".01 .012 .005 .001 -.0005 .0002"/><geom type="ellipsoid" size=".03 .04 .12" pos="0 0 .12"/>
   <body name="hand" pos="0 0 .25"><geom type="ellipsoid" size=".03 .05 .02" density="700"/><geom type="box" fromto="0 0 0 .05 .05 .02" size=".01"/>
    <joint name="finger" type="slide" axis="1 0 0" range="0 .04"/></body></body></body></body></worldbody>
<actuator><position joint="elbow" kp="100" forcerange="-20 20"/><velocity joint="finger" ctrlrange="-.5 .5" forcerange="-5 5"/></actuator></mujoco>)"},
    {"quadruped", R"(<mujoco model="quadruped"><compiler angle="radian" autolimits="true"/>
<default><default class="dog"><joint axis="0 1 0" damping="2" armature="0.01" frictionloss="0.2"/><motor ctrlrange="-23.7 23.7"/>
 <default class="abduction"><joint axis="1 0 0" range="-1.0472 1.0472"/></default>
 <default class="knee"><joint range="-2.7227 -0.83776"/><motor ctrlrange="-45.43 45.43"/></default>
 <default class="visual"><geom type="box" contype="0" conaffinity="0" group="2" mass="0"/></default>
 <default class="collision"><geom group="3" type="capsule"/></default></default></default>
<worldbody><light/><body name="trunk" pos="0 0 0.445" childclass="dog"><inertial pos="0.02 0 -0.0005" quat="0.5 0.5 0.5 0.5" mass="6.9" diaginertia="0.107 0.098 0.024"/>
 <freejoint/><geom class="visual" size=".19 .05 .06"/><geom class="collision" size=".05 .12" euler="0 1.57 0"/>
 <body name="hip" pos="0.19 -0.047 0"><joint class="abduction" name="abduction"/><inertial pos="-.005 .001 0" mass=".68" diaginertia=".0007 .0005 .0004"/>
  <geom class="visual" size=".04 .03 .04"/>
  <body name="calf" pos="0 -0.095 0"><joint class="knee" name="knee"/><geom class="collision" size=".02 .1" pos="0 0 -.1" mass=".4"/><site name="foot" pos="0 0 -.2"/></body></body></body></worldbody>
<actuator><motor class="abduction" name="abduction" joint="abduction"/><motor class="knee" joint="knee"/></actuator>
<keyframe><key name="home" qpos="0 0 .27 1 0 0 0 .1 -1.8"/></keyframe></mujoco>)"},
    {"cartpole", R"(<mujoco model="cartpole"><compiler autolimits="true"/>
<worldbody><geom name="rail" type="capsule" fromto="-2 0 0 2 0 0" size=".02"/>
<body name="cart"><joint name="slider" type="slide" axis="1 0 0" range="-1.8 1.8" damping="5e-4"/><geom name="cart" type="box" size="0.2 0.15 0.1" mass="1"/>
 <body name="pole"><joint name="hinge" axis="0 1 0" damping="2e-6"/><geom type="capsule" fromto="0 0 0 0 0 1" size="0.045" mass=".1"/></body></body>
<body name="ball" pos="1 1 1"><freejoint/><geom size=".1"/></body></worldbody>
<actuator><motor joint="slider" gear="10" ctrlrange="-1 1"/></actuator></mujoco>)"},
    {"chain", R"(<mujoco model="chain"><compiler eulerseq="XYZ"/>
<worldbody><body pos="0 0 2"><joint type="hinge" axis="0 1 0"/><geom type="cylinder" size=".02 .1" pos="0 0 -.1"/>
 <body pos="0 0 -.2" euler="10 20 30"><joint axis="0 1 0"/><geom type="cylinder" size=".02 .1" pos="0 0 -.1"/>
  <body pos="0 0 -.2" euler="-10 0 30"><joint axis="0 1 1"/><geom type="cylinder" size=".02 .1" pos="0 0 -.1" euler="0 5 0"/></body></body></body></worldbody></mujoco>)"},
}};

}  // namespace limber::model::test
